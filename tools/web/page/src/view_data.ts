// SPDX-License-Identifier: BSD-3-Clause
// What the page shows, whoever delivers it: the JSON of /api/view, or the same text inlined in a report. docs/web.md
// describes the fields. Times are seconds after `origin_ns`; a value that is unknown is null.

export type Column = (number | null)[];

/** Poses of base_link in the map frame, one row a pose; all columns have the same length. */
export interface Poses {
  t_s: number[];
  x_m: Column;
  y_m: Column;
  z_m: Column;
  yaw_deg: Column;
  z_sd_m: Column;
  /** Height from air pressure alone. */
  altimeter_m: Column;
  /** Estimated offset of the altimeter against the map, and its standard deviation. */
  bias_m: Column;
  bias_sd_m: Column;
  /** 1: registered on a scan; 0: dead reckoning or start. */
  registered: Column;
}

/** A line in space beside the estimate: a reference, or the path corrected by loops. */
export interface Track {
  name: string;
  t_s: number[];
  x_m: Column;
  y_m: Column;
  z_m: Column;
}

/** Curves of a recording that share times and a unit. */
export interface Signal {
  name: string;
  unit: string;
  t_s: number[];
  series: { name: string; values: Column }[];
}

export interface Floor {
  number: number;
  name: string;
  /** Height of the ground in the map frame. */
  z_m: number;
}

export type Level = 'ok' | 'warning' | 'error' | 'stale';

export interface HealthEntry {
  name: string;
  level: Level;
  message: string;
  value: number | null;
}

export interface Sensor {
  name: string;
  heard: boolean;
  rate_hz: number | null;
  age_s: number | null;
  samples: number | null;
  lost: number | null;
  rejected: number | null;
  dropped: number | null;
  jitter_ms?: number | null;
  latency_ms?: number | null;
  file?: string;
}

/** `isobar status --json`; only what the page uses. */
export interface Status {
  level: Level;
  summary: string;
  report_age_s: number;
  uptime_s: number;
  role: string;
  health: HealthEntry[];
  sensors: Sensor[];
  pose: PoseFigures | null;
  map: { cells: number; tiles: number; disk_bytes: number } | null;
  floor: { known: boolean; number: number; name: string; place: string; z_m: number | null } | null;
  stages: { name: string; median_ms: number | null; p99_ms: number | null; limit_ms: number | null }[];
}

export interface PoseFigures {
  mode: string;
  method: string;
  xy_sd_m: number | null;
  z_sd_m: number | null;
  overlap: number | null;
}

export interface Setting {
  key: string;
  value: string;
  unit: string;
  doc: string;
  basic: boolean;
  /** "default", "FILE:LINE", or a sentence. */
  source: string;
  is_default: boolean;
}

export interface MapState {
  /** Changes with the map frame: chunks of two epochs do not belong together. */
  epoch: number;
  /** Of the newest change. */
  change: number;
  points: number;
  /** Points that were left out for want of memory. */
  left_out: number;
}

export interface ViewData {
  schema: 1;
  kind: 'live' | 'run' | 'recording';
  title: string;
  version: string;
  /** Robot clock at t_s = 0. A text: it has more digits than a number of JavaScript. */
  origin_ns: string;
  can_act: boolean;
  poses: Poses;
  tracks: Track[];
  floors: Floor[];
  signals: Signal[];
  sensors: Sensor[];
  /** Level and sentence of what is worth knowing: damaged files, poses without a scan, lost data. */
  health: HealthEntry[];
  counters: { name: string; count: number; message: string }[];
  settings: Setting[];
  map: MapState;
}

export function empty_poses(): Poses {
  return {
    t_s: [], x_m: [], y_m: [], z_m: [], yaw_deg: [], z_sd_m: [], altimeter_m: [], bias_m: [], bias_sd_m: [],
    registered: [],
  };
}
