// SPDX-License-Identifier: BSD-3-Clause
// The points of the map on the graphics card: one draw call a cube, coloured by height, cut by a slice of heights.
import * as THREE from 'three';
import { height_colours, kColours } from './colour_map';
import type { MapPiece } from './map_chunks';

const kVertex = `
uniform float step_m;
uniform vec2 slice_m;
uniform vec2 range_m;
uniform vec2 slab_m;
uniform float floors_m[FLOORS];
uniform int floor_count;
uniform float pixels_per_m;
uniform float larger;
uniform float least_px;
uniform sampler2D colours;
varying vec3 colour;
void main() {
  vec4 world = modelMatrix * vec4(position * step_m, 1.0);
  vec4 seen = viewMatrix * world;
  gl_Position = projectionMatrix * seen;
  gl_PointSize = larger * clamp(pixels_per_m / max(0.1, -seen.z), least_px, 5.0);
  bool shown = world.z >= slice_m.x && world.z <= slice_m.y;
  bool in_slab = floor_count == 0;
  for (int i = 0; i < FLOORS; ++i) {
    float above = world.z - floors_m[i];
    if (i >= floor_count) break;
    if (above > slab_m.x && above < slab_m.y) in_slab = true;
  }
  if (!shown || !in_slab) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  float at = (world.z - range_m.x) / max(0.01, range_m.y - range_m.x);
  colour = texture2D(colours, vec2(clamp(at, 0.002, 0.998), 0.5)).rgb;
}`;
const kFragment = `
varying vec3 colour;
void main() {
  gl_FragColor = vec4(colour, 1.0);
}`;

/** Edge of a drawn point in space [m], while it is larger than a pixel. */
const kPointM = 0.07;
/** Thinned points are at most so much larger: beyond, they look like another map. */
const kMostLarger = 3;
/** One of this many points is kept for the extent of the map; of a few points more. */
const kSampleStep = 61;
const kLeastSamples = 100;
/** A map of fewer points than this is drawn in points of 3 pixels: single ones of one pixel can hardly be seen. */
const kSparsePoints = 100_000;
/** Floors without their ceilings are shown between these heights above the ground [m]. */
const kSlabM = [-0.5, 1.9];
const kMostFloors = 32;

/** Puts the points into a random order, so that the first part of them is a thinned whole. Always the same order. */
function shuffle(data: Uint16Array): void {
  const words = new Uint32Array(data.buffer); // two a point
  let random = 1;
  for (let last = words.length / 2 - 1; last > 0; --last) {
    random = (Math.imul(random, 1_664_525) + 1_013_904_223) >>> 0;
    const other = Math.floor((random / 2 ** 32) * (last + 1));
    for (let word = 0; word < 2; ++word) {
      const kept = words[2 * last + word];
      words[2 * last + word] = words[2 * other + word];
      words[2 * other + word] = kept;
    }
  }
}

interface Drawn {
  points: THREE.Points;
  /** x, y, z in the map frame. */
  samples_m: Float32Array;
}

export class MapPoints {
  readonly group = new THREE.Group();
  private readonly chunks = new Map<string, Drawn>();
  private epoch = -1;
  private total = 0;
  private readonly material = new THREE.ShaderMaterial({
    vertexShader: kVertex,
    fragmentShader: kFragment,
    defines: { FLOORS: kMostFloors },
    uniforms: {
      step_m: { value: 0.00025 },
      slice_m: { value: new THREE.Vector2(-1e6, 1e6) },
      range_m: { value: new THREE.Vector2(0, 1) },
      slab_m: { value: new THREE.Vector2(...kSlabM) },
      floors_m: { value: new Array(kMostFloors).fill(0) },
      floor_count: { value: 0 },
      pixels_per_m: { value: 50 },
      larger: { value: 1 },
      least_px: { value: 1 },
      colours: { value: null },
    },
  });

  get count(): number {
    return this.total;
  }

  /** Takes what has changed. */
  apply(piece: MapPiece): void {
    if (piece.epoch !== this.epoch) this.clear();
    this.epoch = piece.epoch;
    this.material.uniforms.step_m.value = piece.step_m;
    for (const chunk of piece.chunks) {
      this.remove(chunk.key);
      if (chunk.points.length > 0) this.add(chunk.key, chunk.corner_m, chunk.points, piece.step_m);
    }
  }

  clear(): void {
    for (const key of [...this.chunks.keys()]) this.remove(key);
  }

  set_dark(dark: boolean): void {
    const texture = new THREE.DataTexture(height_colours(dark), kColours, 1);
    texture.needsUpdate = true;
    this.material.uniforms.colours.value?.dispose();
    this.material.uniforms.colours.value = texture;
  }

  set_slice(lowest_m: number, highest_m: number): void {
    this.material.uniforms.slice_m.value.set(lowest_m, highest_m);
  }

  /** Leaves out what is above a person on these floors: ceilings hide what is below; none: shows all. */
  cut_above(floors_m: number[]): void {
    const told = floors_m.slice(0, kMostFloors);
    this.material.uniforms.floors_m.value = [...told, ...new Array(kMostFloors - told.length).fill(0)];
    this.material.uniforms.floor_count.value = told.length;
  }

  /** Share of the map that cut_above() leaves of it, 0 … 1. */
  share_left(floors_m: number[]): number {
    let all = 0;
    let left = 0;
    for (const { z } of this.samples()) {
      ++all;
      if (floors_m.some((floor_m) => z - floor_m > kSlabM[0] && z - floor_m < kSlabM[1])) ++left;
    }
    return all > 0 ? left / all : 1;
  }

  set_range(lowest_m: number, highest_m: number): void {
    this.material.uniforms.range_m.value.set(lowest_m, highest_m);
  }

  /** @param height_px of the canvas in pixels of the screen */
  set_view(height_px: number, field_of_view_deg: number): void {
    this.material.uniforms.pixels_per_m.value =
      (kPointM * height_px) / (2 * Math.tan((field_of_view_deg * Math.PI) / 360));
  }

  /**
   * Which of the points are drawn next, 0 … 1: their order is random, so that each part is a thinned whole.
   * @param is_alone the part stands for all: its points are larger, so that surfaces stay closed
   */
  set_part(from: number, to: number, is_alone: boolean): void {
    this.material.uniforms.larger.value = is_alone ? Math.min(kMostLarger, Math.sqrt(1 / (to - from))) : 1;
    for (const { points: { geometry } } of this.chunks.values()) {
      const points = geometry.getAttribute('position').count;
      const first = Math.ceil(from * points);
      geometry.setDrawRange(first, Math.ceil(to * points) - first);
    }
  }

  /** Heights between which nearly all points lie; null: none yet. */
  height_range_m(): [number, number] | null {
    const heights: number[] = [];
    for (const { samples_m } of this.chunks.values()) for (let i = 2; i < samples_m.length; i += 3) heights.push(samples_m[i]);
    heights.sort((a, b) => a - b);
    if (heights.length === 0) return null;
    const part = (share: number) => heights[Math.round(share * (heights.length - 1))];
    return [part(0.005), part(0.995)];
  }

  /** Some points of the whole map. */
  *samples(): Generator<THREE.Vector3> {
    for (const { samples_m } of this.chunks.values()) {
      for (let i = 0; i < samples_m.length; i += 3) yield new THREE.Vector3(samples_m[i], samples_m[i + 1], samples_m[i + 2]);
    }
  }

  private add(key: string, corner_m: [number, number, number], data: Uint16Array, step_m: number): void {
    const geometry = new THREE.BufferGeometry();
    shuffle(data);
    const buffer = new THREE.InterleavedBuffer(data, 4);
    geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(buffer, 3, 0));
    const count = data.length / 4;
    const step = Math.max(1, Math.min(kSampleStep, Math.floor(count / kLeastSamples)));
    const samples = new Float32Array(3 * Math.ceil(count / step));
    for (let from = 0, to = 0; from < data.length; from += 4 * step, to += 3) {
      for (let axis = 0; axis < 3; ++axis) samples[to + axis] = corner_m[axis] + data[from + axis] * step_m;
    }
    const edge_m = 65_536 * step_m;
    geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3().setScalar(edge_m / 2), edge_m * 0.87);
    const points = new THREE.Points(geometry, this.material);
    points.position.set(...corner_m);
    this.group.add(points);
    this.chunks.set(key, { points, samples_m: samples });
    this.note_total(count);
  }

  private note_total(added: number): void {
    this.total += added;
    this.material.uniforms.least_px.value = this.total < kSparsePoints ? 3 : 1;
  }

  private remove(key: string): void {
    const drawn = this.chunks.get(key);
    if (!drawn) return;
    this.note_total(-drawn.points.geometry.getAttribute('position').count);
    this.group.remove(drawn.points);
    drawn.points.geometry.dispose();
    this.chunks.delete(key);
  }
}
