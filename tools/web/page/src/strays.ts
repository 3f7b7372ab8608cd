// SPDX-License-Identifier: BSD-3-Clause
// Places of a map that lie far outside of it.
import * as THREE from 'three';

/** Leaves out single places far beyond all others, as a return through a window: the map would be small in the picture. */
export function without_strays(places: THREE.Vector3[]): THREE.Vector3[] {
  if (places.length === 0) return places;
  const part = (values: number[], share: number) => values.sort((a, b) => a - b)[Math.round(share * (values.length - 1))];
  const centre = new THREE.Vector3(...(['x', 'y', 'z'] as const).map((axis) => part(places.map((place) => place[axis]), 0.5)));
  const farthest = 1.5 * part(places.map((place) => place.distanceTo(centre)), 0.98);
  return places.filter((place) => place.distanceTo(centre) <= farthest);
}
