// SPDX-License-Identifier: BSD-3-Clause
// Robot and paths in the map.
import * as THREE from 'three';
import { Line2 } from 'three/addons/lines/Line2.js';
import { LineGeometry } from 'three/addons/lines/LineGeometry.js';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import type { Column } from './view_data';

export interface Line3 {
  x_m: Column;
  y_m: Column;
  z_m: Column;
}

/** A path of constant width on the screen; of a long one every n-th pose is drawn. */
export class PathLine {
  private static readonly kMostPoints = 20_000;
  private readonly material: LineMaterial;
  private line: Line2 | null = null;
  private step = 1;

  constructor(private readonly parent: THREE.Object3D, width_px: number, planes: THREE.Plane[], opacity = 1) {
    // Above the points: a path inside a building would be hidden by its ceilings.
    this.material = new LineMaterial({ linewidth: width_px, clippingPlanes: planes, transparent: true, opacity, depthTest: false });
  }

  set_colour(colour: string): void {
    this.material.color.set(colour);
  }

  set(path: Line3): void {
    const known: number[] = [];
    this.step = Math.max(1, Math.ceil(path.x_m.length / PathLine.kMostPoints));
    for (let i = 0; i < path.x_m.length; i += this.step) {
      const [x, y, z] = [path.x_m[i], path.y_m[i], path.z_m[i]];
      if (x !== null && y !== null && z !== null) known.push(x, y, z);
    }
    if (this.line) {
      this.parent.remove(this.line);
      this.line.geometry.dispose();
      this.line = null;
    }
    if (known.length < 6) return;
    this.line = new Line2(new LineGeometry().setPositions(known), this.material);
    this.line.frustumCulled = false;
    this.parent.add(this.line);
  }

  /** Draws the path up to this row only. */
  show_until(row: number): void {
    if (this.line) this.line.geometry.instanceCount = Math.max(0, Math.floor(row / this.step));
  }
}

/** The robot: an arrow of constant size on the screen, above everything. */
export class RobotMarker {
  private static readonly kScreenShare = 0.026;
  readonly object = new THREE.Group();
  private readonly fill: THREE.MeshBasicMaterial;
  private readonly rim: THREE.MeshBasicMaterial;

  constructor() {
    const arrow = (scale: number) => {
      const shape = new THREE.Shape([[1, 0], [-0.75, 0.72], [-0.4, 0], [-0.75, -0.72]].map(([x, y]) => new THREE.Vector2(x * scale, y * scale)));
      return new THREE.ShapeGeometry(shape);
    };
    const options = { depthTest: false, depthWrite: false, side: THREE.DoubleSide, transparent: true };
    this.rim = new THREE.MeshBasicMaterial(options);
    this.fill = new THREE.MeshBasicMaterial(options);
    const rim = new THREE.Mesh(arrow(1.35), this.rim);
    const fill = new THREE.Mesh(arrow(1), this.fill);
    rim.renderOrder = 10;
    fill.renderOrder = 11;
    this.object.add(rim, fill);
    this.object.visible = false;
  }

  set_colours(fill: string, rim: string): void {
    this.fill.color.set(fill);
    this.rim.color.set(rim);
  }

  set(x_m: number, y_m: number, z_m: number, yaw_deg: number): void {
    this.object.position.set(x_m, y_m, z_m);
    this.object.rotation.z = (yaw_deg * Math.PI) / 180;
    this.object.visible = true;
  }

  hide(): void {
    this.object.visible = false;
  }

  /** Before each frame. */
  scale_to(camera: THREE.Camera): void {
    this.object.scale.setScalar(Math.max(0.25, RobotMarker.kScreenShare * camera.position.distanceTo(this.object.position)));
  }
}
