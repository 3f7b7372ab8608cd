// SPDX-License-Identifier: BSD-3-Clause
// The charts of a report as they stand in it: <script type="application/json" class="isobar-chart">, as
// tools/report/curve_chart.cpp and box_chart.cpp write them.

export interface Curve {
  /** Empty: not in the legend. */
  name: string;
  /** A colour, or the name of a custom property, "--ink". */
  colour: string;
  width: number;
  dash: number[];
  /** Each value holds until the next x, with the area below it filled. */
  stepped?: boolean;
  /** Ascending. */
  x: number[];
  /** null interrupts the line. */
  y: (number | null)[];
}

export interface Area {
  colour: string;
  x: number[];
  low: (number | null)[];
  high: (number | null)[];
}

export interface Dots {
  colour: string;
  x: number[];
  y: (number | null)[];
}

export interface Span {
  from: number;
  to: number;
  label: string;
}

export interface CurveChartData {
  kind: 'curves';
  x_label: string;
  y_label: string;
  x_unit: string;
  y_unit: string;
  y_decimals: number;
  curves: Curve[];
  areas: Area[];
  dots: Dots[];
  spans: Span[];
  x_range: [number, number] | null;
  y_range: [number, number] | null;
  logarithmic: boolean;
}

export interface Box {
  name: string;
  colour: string;
  /** null: no data. */
  median: number | null;
  p05?: number;
  q25?: number;
  q75?: number;
  p95?: number;
}

export interface BoxChartData {
  kind: 'boxes';
  x_label: string;
  unit: string;
  decimals: number;
  range: [number, number];
  logarithmic: boolean;
  rows: Box[];
}

export type ChartData = CurveChartData | BoxChartData;
