// SPDX-License-Identifier: BSD-3-Clause
// The page of a finished run or of a recording, with a slider for its time.
import { counters_table } from './counters_table';
import { set_text } from './dom';
import { count, fixed } from './format';
import { make_layout, type Layout } from './layout';
import type { MapPiece } from './map_chunks';
import { SignalsPanel } from './signals_panel';
import type { Link, Listener } from './source';
import { TimeSlider } from './time_slider';
import type { Floor, HealthEntry, Level, ViewData } from './view_data';

const kSeverity: Level[] = ['ok', 'warning', 'stale', 'error'];

function worst(health: HealthEntry[]): { level: Level; sentence: string } {
  const first = [...health].sort((a, b) => kSeverity.indexOf(b.level) - kSeverity.indexOf(a.level))[0];
  return first && first.level !== 'ok' ? { level: first.level, sentence: first.message } : { level: 'ok', sentence: first?.message ?? '' };
}

/** Index of the last time that is not after t_s; 0 before all. */
export function row_at(t_s: readonly number[], time_s: number): number {
  let low = 0;
  let high = t_s.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (t_s[middle] <= time_s) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}

function floor_name(floors: Floor[], base_z_m: number): string {
  const below = floors.filter((floor) => base_z_m >= floor.z_m - 0.6 && base_z_m < floor.z_m + 1.6);
  const nearest = below.sort((a, b) => Math.abs(a.z_m - base_z_m) - Math.abs(b.z_m - base_z_m))[0];
  return nearest ? nearest.name || fixed(nearest.number, 0) : '';
}

export class RunPage implements Listener {
  private layout!: Layout;
  private view!: ViewData;
  private readonly slider = new TimeSlider();
  private signals: SignalsPanel | null = null;

  on_view(view: ViewData): void {
    this.view = view;
    const layout = make_layout(view);
    this.layout = layout;
    layout.pose.root.after(this.slider.root);
    this.show_health();
    layout.rates.set(view.sensors);
    layout.slicer.set_floors(view.floors);
    layout.settings.set(view.settings);
    layout.height.on_pick = (t_s) => this.slider.go_to(t_s);
    if (view.counters.length > 0) layout.side.append(counters_table(view.counters));
    if (view.signals.length > 0) {
      this.signals = new SignalsPanel(view.signals, (t_s) => this.slider.go_to(t_s));
      document.querySelector('main')!.insertBefore(this.signals.root, layout.below);
    }
    this.show_paths();
    this.slider.on_time = (t_s) => this.show_time(t_s);
    this.slider.set_range(...this.range_s());
  }

  on_map(piece: MapPiece): void {
    this.layout.map?.apply(piece);
    const left_out = this.view.map.left_out;
    set_text(this.layout.map_foot, `${count(this.layout.map?.point_count ?? 0)} points${left_out ? `, ${count(left_out)} left out` : ''}`);
  }

  on_link(link: Link): void {
    this.layout.banner.hidden = link.ok;
    set_text(this.layout.banner, link.text);
  }

  private show_health(): void {
    const { level, sentence } = worst(this.view.health);
    this.layout.summary.set(level, sentence);
    this.layout.health.set(this.view.health);
  }

  private show_paths(): void {
    const { poses, tracks, map } = this.view;
    const has_poses = poses.t_s.length > 1;
    const path = has_poses ? poses : tracks[0];
    if (path) this.layout.map?.set_path(path, path);
    if (has_poses && tracks[0]) this.layout.map?.set_other_path(tracks[0]);
    if (map.points === 0 && this.layout.map) {
      this.layout.map_note.classList.add('below');
      this.layout.slicer.root.hidden = true;
      set_text(this.layout.map_note, this.view.kind === 'recording'
        ? 'A recording has no map yet. Make one: isobar replay RECORDING --out RUN, then isobar web RUN.'
        : 'This run has no map: neither map.ply nor the folder map.');
    }
    if (!poses.bias_sd_m.some((sd) => sd !== null && sd > 0)) this.layout.height.hide_bias();
    if (has_poses) this.layout.height.set_poses(poses);
    else if (path) this.layout.height.set_poses({ ...poses, ...path, yaw_deg: [], altimeter_m: nulls(path), bias_m: nulls(path), bias_sd_m: nulls(path), z_sd_m: nulls(path) });
  }

  private range_s(): [number, number] {
    const times = [this.view.poses.t_s, ...this.view.tracks.map((track) => track.t_s), ...this.view.signals.map((signal) => signal.t_s)].filter((t) => t.length > 0);
    if (times.length === 0) return [0, 1];
    return [Math.min(...times.map((t) => t[0])), Math.max(...times.map((t) => t[t.length - 1]))];
  }

  private show_time(t_s: number): void {
    const { poses, tracks } = this.view;
    this.layout.height.mark(t_s);
    this.signals?.mark(t_s);
    const path = poses.t_s.length > 1 ? poses : tracks[0];
    if (!path) return;
    const row = row_at(path.t_s, t_s);
    const [x, y, z] = [path.x_m[row], path.y_m[row], path.z_m[row]];
    const yaw = poses.yaw_deg[row] ?? heading(path, row);
    this.layout.pose.set(x, y, z, yaw, poses.z_sd_m[row] ?? null);
    this.layout.pose.set_mode(poses.t_s.length > 1 ? (poses.registered[row] ? 'registered' : 'prior') : 'reference');
    if (x !== null && y !== null && z !== null) {
      this.layout.map?.set_robot(x, y, z, yaw ?? 0);
      this.layout.pose.set_floor(floor_name(this.view.floors, z));
    }
    this.layout.map?.show_path_until(row);
  }
}

function nulls(path: { t_s: number[] }): null[] {
  return path.t_s.map(() => null);
}

/** Direction of the way at a row [deg]: a track has no attitude. */
function heading(path: { x_m: (number | null)[]; y_m: (number | null)[] }, row: number): number | null {
  const before = Math.max(0, row - 10);
  const [dx, dy] = [(path.x_m[row] ?? 0) - (path.x_m[before] ?? 0), (path.y_m[row] ?? 0) - (path.y_m[before] ?? 0)];
  return Math.hypot(dx, dy) < 0.01 ? null : (Math.atan2(dy, dx) * 180) / Math.PI;
}
