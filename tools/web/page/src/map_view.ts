// SPDX-License-Identifier: BSD-3-Clause
// The map in three dimensions: points, paths and robot. Draws only when something has changed; of many points each frame
// draws as many as this machine draws in time, larger; at rest the whole picture grows unseen, and is shown then. Knows nothing of where the
// data come from: see MapPiece and Poses.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { DepthShading } from './depth_shading';
import { element, on_theme_change, style_value } from './dom';
import type { MapPiece } from './map_chunks';
import { MapPoints } from './map_points';
import { FrameBudget } from './frame_budget';
import { without_strays } from './strays';
import { PathLine, RobotMarker, type Line3 } from './map_tracks';

const kFieldOfViewDeg = 50;
/** Least share of the map that is left without its ceilings. */
const kLeastLeft = 1 / 3;
const kDarkQuery = '(prefers-color-scheme: dark)';
/** Of a screen with many pixels only so many are drawn per CSS pixel: points stay points, at half the work. */
const kMostPixelRatio = 1.5;
/** A map that grows moves the view only where it would move by more than this share of its distance. */
const kGentleShare = 0.04;
/** Of the points that a frame may draw, into a picture that is not shown yet. */
const kUnseenShare = 0.6;

export class MapView {
  readonly root = element('div', 'map-view');
  /** Called when the range of heights has changed. */
  on_range: (range_m: [number, number]) => void = () => {};
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly overlay = new THREE.Scene();
  private readonly shading: DepthShading;
  private readonly camera = new THREE.PerspectiveCamera(kFieldOfViewDeg, 1, 0.2, 5000);
  private readonly controls: OrbitControls;
  private readonly points = new MapPoints();
  private readonly planes = [new THREE.Plane(new THREE.Vector3(0, 0, 1), 1e6), new THREE.Plane(new THREE.Vector3(0, 0, -1), 1e6)];
  private readonly whole_path = new PathLine(this.overlay, 1.5, this.planes, 0.45);
  private readonly path = new PathLine(this.overlay, 3, this.planes);
  private readonly other_path = new PathLine(this.overlay, 1.5, this.planes, 0.8);
  private readonly robot = new RobotMarker();
  private range_m: [number, number] | null = null;
  private slice_m: [number, number] | null = null;
  private fitted: THREE.Vector3[] = [];
  private floors_m: number[] = [];
  private touched = false;
  private readonly budget: FrameBudget;
  /** The picture of the points: how much of it is drawn, 0 … 1; shown at once, thinned, or when it is whole; outdated. */
  private picture = { share: 1, is_shown: true, is_old: false };
  private waiting = 0;  // number of the frame that was asked for; 0: none
  /** All pieces of the first map have come; it is drawn without a wait for the frame before. */
  private is_whole = false;
  private is_urgent = false;
  private follows = false;
  frames = 0;

  /** @throws Error when the browser has no WebGL */
  constructor() {
    this.renderer = new THREE.WebGLRenderer({ antialias: false, powerPreference: 'high-performance' });
    this.renderer.localClippingEnabled = true;
    this.renderer.debug.checkShaderErrors = false;  // asking waits for the compiler
    this.renderer.autoClear = false;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, kMostPixelRatio));
    const canvas = this.renderer.domElement;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', 'Map in three dimensions, coloured by height');
    this.root.append(canvas);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-12, -16, 18);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = Math.PI * 0.49;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.draw_anew());
    this.controls.addEventListener('start', () => (this.touched = true));
    this.budget = new FrameBudget(this.renderer.getContext() as WebGL2RenderingContext);
    this.shading = new DepthShading(this.renderer);
    this.scene.add(this.points.group);
    this.overlay.add(this.robot.object);
    this.take_theme();
    on_theme_change(() => this.take_theme());
    new ResizeObserver(() => this.resize()).observe(this.root);
  }

  /** Points that are drawn. */
  get point_count(): number {
    return this.points.count;
  }

  apply(piece: MapPiece): void {
    const is_first = this.points.count === 0;
    this.points.apply(piece);
    if (!piece.more) {
      this.take_range();
      this.cut();
    }
    if (!this.touched && !piece.more) this.fit_places(without_strays([...this.points.samples()]), false, true);
    const completes = !piece.more && !this.is_whole && this.points.count > 0;
    this.is_whole ||= completes;
    this.is_urgent ||= completes;
    this.draw_anew(is_first || completes);
  }

  clear(): void {
    this.points.clear();
    this.is_whole = false;
    this.range_m = null;
    this.draw_anew();
  }

  /** The path that was driven; `whole`: the faint line beneath it, of the whole run. */
  set_path(path: Line3, whole: Line3 | null = null): void {
    this.path.set(path);
    if (whole) this.whole_path.set(whole);
    if (!this.touched && this.points.count === 0 && path.x_m.length > 1) this.fit_path(path);
    this.draw_soon();
  }

  /** A second line: a reference, or the corrected path. */
  set_other_path(path: Line3): void {
    this.other_path.set(path);
    this.draw_soon();
  }

  show_path_until(row: number): void {
    this.path.show_until(row);
    this.draw_soon();
  }

  set_robot(x_m: number, y_m: number, z_m: number, yaw_deg: number): void {
    if (this.follows) {
      const step = new THREE.Vector3(x_m, y_m, z_m).sub(this.controls.target);
      this.camera.position.add(step);
      this.controls.target.add(step);
      this.controls.update();
    }
    this.robot.set(x_m, y_m, z_m, yaw_deg);
    this.draw_soon();
  }

  hide_robot(): void {
    this.robot.hide();
    this.draw_soon();
  }

  /** Keeps the robot in the middle. */
  set_follow(follows: boolean): void {
    this.follows = follows;
    this.touched ||= follows;
  }

  /** Shows heights between these only, in all colours; null: all. */
  set_slice(slice_m: [number, number] | null): void {
    const [low, high] = slice_m ?? [-1e6, 1e6];
    this.slice_m = slice_m;
    this.points.set_slice(low, high);
    this.planes[0].constant = -low;
    this.planes[1].constant = high;
    this.colour();
  }

  /** Leaves out the ceilings over these floors; none: shows all. */
  cut_above(floors_m: number[]): void {
    this.floors_m = floors_m;
    this.cut();
    this.draw_anew();
  }

  /** Where most of the map lies elsewhere (a lidar on a mast of unknown height, open land) nothing is cut. */
  private cut(): void {
    this.points.cut_above(this.points.share_left(this.floors_m) < kLeastLeft ? [] : this.floors_m);
  }

  /** The whole map, from obliquely above or from the top. */
  fit(from_top = false): void {
    this.fit_places(without_strays([...this.points.samples()]), from_top);
  }

  private fit_path(path: Line3): void {
    const step = Math.max(1, Math.floor(path.x_m.length / 2000));
    const places: THREE.Vector3[] = [];
    for (let i = 0; i < path.x_m.length; i += step) places.push(new THREE.Vector3(path.x_m[i] ?? 0, path.y_m[i] ?? 0, path.z_m[i] ?? 0));
    this.fit_places(places, false);
  }

  private fit_places(places: THREE.Vector3[], from_top: boolean, is_gentle = false): void {
    if (places.length === 0) return;
    this.fitted = places;
    const box = new THREE.Box3().setFromPoints(places);
    const centre = box.getCenter(new THREE.Vector3());
    const direction = (from_top ? new THREE.Vector3(0, -0.001, 1) : new THREE.Vector3(-0.45, -0.75, 0.8)).normalize();
    const distance = Math.max(3, 1.08 * this.distance_for(places, centre, direction));
    const position = centre.clone().addScaledVector(direction, distance);
    if (is_gentle && position.distanceTo(this.camera.position) < kGentleShare * distance) return;
    this.controls.target.copy(centre);
    this.camera.position.copy(position);
    this.camera.far = Math.max(1000, 10 * distance);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw_anew();
  }

  /** Distance from the centre at which all places are in view. */
  private distance_for(places: THREE.Vector3[], centre: THREE.Vector3, direction: THREE.Vector3): number {
    const right = new THREE.Vector3().crossVectors(new THREE.Vector3(0, 0, 1), direction).normalize();
    const up = new THREE.Vector3().crossVectors(direction, right);
    const half = Math.tan((kFieldOfViewDeg * Math.PI) / 360);
    return places.reduce((distance, place) => {
      const from_centre = place.clone().sub(centre);
      const across = Math.max(Math.abs(from_centre.dot(right)) / (half * this.camera.aspect), Math.abs(from_centre.dot(up)) / half);
      return Math.max(distance, from_centre.dot(direction) + across);
    }, 0);
  }

  private take_range(): void {
    const range = this.points.height_range_m();
    if (!range) return;
    const known = this.range_m;
    if (known && Math.abs(known[0] - range[0]) < 0.2 && Math.abs(known[1] - range[1]) < 0.2) return;
    this.range_m = range;
    this.colour();
    this.on_range(range);
  }

  private colour(): void {
    const range = this.slice_m ?? this.range_m;
    if (range) this.points.set_range(range[0], range[1]);
    this.draw_anew();
  }

  private take_theme(): void {
    this.shading.set_ground(style_value('--map-ground'));
    this.points.set_dark(matchMedia(kDarkQuery).matches);
    for (const line of [this.path, this.whole_path]) line.set_colour(style_value('--accent'));
    this.other_path.set_colour(style_value('--ink'));
    this.robot.set_colours(style_value('--accent'), style_value('--map-rim'));
    this.draw_anew();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    const ratio = this.renderer.getPixelRatio();
    this.points.set_view(height * ratio, kFieldOfViewDeg);
    this.shading.resize(Math.floor(width * ratio), Math.floor(height * ratio));
    if (!this.touched) this.fit_places(this.fitted, false);
    // Before this is painted: a canvas of another size is empty.
    this.is_urgent = true;
    this.draw_anew();
    this.frame();
  }

  /** Begins another picture of the points. @param is_shown at once: what is there is of another view */
  private draw_anew(is_shown = true): void {
    const { picture } = this;
    // One that grows unseen is finished first: maps that come faster than they are drawn would never be shown.
    if (!is_shown && picture.share < 1) picture.is_old = !picture.is_shown;
    else this.picture = { share: 0, is_shown, is_old: false };
    this.draw_soon();
  }

  private draw_soon(): void {
    this.waiting ||= requestAnimationFrame(() => this.frame());
  }

  private frame(): void {
    cancelAnimationFrame(this.waiting);
    this.waiting = 0;
    if (this.budget.is_busy && !this.is_urgent) return this.draw_soon();
    this.is_urgent = false;
    const began_ms = performance.now();
    const drawn = this.picture.share < 1 ? this.draw_points() : 0;
    this.robot.scale_to(this.camera);
    this.shading.render();
    this.renderer.render(this.overlay, this.camera);
    ++this.frames;
    this.budget.drawn(drawn, began_ms);
    if (this.picture.share < 1) this.draw_soon();
    else if (this.picture.is_old) this.draw_anew(false);
  }

  /** Draws the next part of the points. @return their number */
  private draw_points(): number {
    const { picture } = this;
    const total = Math.max(1, this.points.count);
    // What grows unseen leaves time to the rest of the page, such as charts that follow the robot.
    const points = (picture.is_shown ? 1 : kUnseenShare) * this.budget.points;
    const to = Math.min(1, picture.share + points / total);
    if (picture.share === 0) this.shading.begin();
    this.points.set_part(picture.share, to, picture.is_shown);
    this.shading.draw(this.scene, this.camera);
    if (picture.is_shown || to === 1) this.shading.show(this.camera);
    const drawn = (to - picture.share) * total;
    picture.share = to;
    if (picture.is_shown && to < 1) this.picture = { share: 0, is_shown: false, is_old: false };
    return drawn;
  }
}
