// SPDX-License-Identifier: BSD-3-Clause
// What delivers the data, apart from what draws them: run_source (files that a server has read), live_source (a
// running isobard), inline_source (a page that holds its own data).
import type { MapPiece } from './map_chunks';
import type { Floor, Setting, Status, ViewData } from './view_data';

export interface LivePose {
  t_s: number;
  x_m: number;
  y_m: number;
  z_m: number;
  yaw_deg: number;
  z_sd_m: number | null;
  altimeter_m: number | null;
  bias_m: number | null;
  bias_sd_m: number | null;
  registered: number;
  session: number;
  mode: string;
  /** Empty: the robot knows where it is. */
  lost: string;
}

/** Words on whether data come; empty: all is well. */
export interface Link {
  ok: boolean;
  text: string;
}

export interface Listener {
  on_view(view: ViewData): void;
  on_map(piece: MapPiece): void;
  /** Live sources only. */
  on_pose?(pose: LivePose): void;
  on_status?(status: Status): void;
  on_floors?(floors: Floor[], current: number | null): void;
  on_settings?(settings: Setting[]): void;
  on_link?(link: Link): void;
  on_action?(text: string, failed: boolean): void;
}

export interface Source {
  start(listener: Listener): void;
}
