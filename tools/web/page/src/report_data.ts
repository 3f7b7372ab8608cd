// SPDX-License-Identifier: BSD-3-Clause
// What a comparison of runs with a reference shows: <script type="application/json" id="isobar-report">. Lengths in
// metres; columns of one object have the same length. Maps stand beside it, in base64, as <script id="isobar-map-N">.
import type { Floor } from './view_data';

export interface Way {
  /** Travelled by the reference; ascending. */
  distance_m: number[];
  x_m: number[];
  y_m: number[];
  z_m: number[];
}

export interface Line extends Way {
  name: string;
  colour: string;
  width: number;
  dash: number[];
}

export interface Method extends Line {
  /** Estimate minus reference. */
  error_m: number[];
  /** "ok", "incomplete" or "LOST", and why. */
  verdict: string;
  reason: string;
  has_map: boolean;
}

export interface ReportData {
  schema: 1;
  /** Index of the method that the report is about. */
  main: number;
  reference: Line;
  /** Its height where a method has one; only distance and z. */
  altimeter: Line | null;
  methods: Method[];
  /** Distances between which the floor is flat. */
  flat: [number, number][];
  floors: Floor[];
}
