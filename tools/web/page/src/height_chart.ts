// SPDX-License-Identifier: BSD-3-Clause
// Height over time: above, the estimate with two standard deviations, the altimeter, and the altimeter less its
// estimated bias; below, that bias with two standard deviations.
import { Chart } from './chart';
import { element } from './dom';
import type { Column, Poses } from './view_data';

const kHidden = { colour: '--none', unit: 'm', decimals: 3, width: 0, hidden_label: true };

function plus(a: Column, b: Column, factor: number): Column {
  return a.map((value, i) => {
    const other = b[i];
    return value === null || other === null ? null : value + factor * other;
  });
}

export class HeightChart {
  readonly root = element('div', 'height-chart');
  on_pick: (t_s: number) => void = () => {};
  private readonly height = new Chart({
    y_label: 'height m',
    least_extent: 0.4,
    sync: 'height',
    series: [
      { label: 'altimeter', colour: '--muted', unit: 'm', decimals: 2, width: 1 },
      { label: 'altimeter − bias', colour: '--air', unit: 'm', decimals: 2, width: 1 },
      { label: 'z + 2 σ', ...kHidden },
      { label: 'z − 2 σ', ...kHidden },
      { label: 'z', colour: '--accent', unit: 'm', decimals: 3, width: 2 },
    ],
    bands: [{ between: [3, 4], colour: '--accent-band' }],
  });
  private readonly bias = new Chart({
    y_label: 'bias m',
    least_extent: 0.2,
    sync: 'height',
    series: [
      { label: 'bias + 2 σ', ...kHidden },
      { label: 'bias − 2 σ', ...kHidden },
      { label: 'bias of the altimeter', colour: '--air', unit: 'm', decimals: 3, width: 1.5 },
    ],
    bands: [{ between: [1, 2], colour: '--air-band' }],
  });

  constructor() {
    this.height.root.classList.add('chart-main');
    this.bias.root.classList.add('chart-strip');
    this.root.append(this.height.root, this.bias.root);
    for (const chart of [this.height, this.bias]) chart.on_pick = (t_s) => this.on_pick(t_s);
  }

  /** @param span_s only the newest so many seconds; 0: all */
  set_poses(poses: Poses, span_s = 0): void {
    // Zero: a method without a bias, or before the first estimate.
    const has_bias = poses.bias_sd_m.map((sd) => sd !== null && sd > 0);
    const bias = poses.bias_m.map((value, i) => (has_bias[i] ? value : null));
    const columns = [
      poses.t_s, poses.altimeter_m, plus(poses.altimeter_m, bias, -1),
      plus(poses.z_m, poses.z_sd_m, 2), plus(poses.z_m, poses.z_sd_m, -2), poses.z_m,
    ];
    const of_bias = [poses.t_s, plus(bias, poses.bias_sd_m, 2), plus(bias, poses.bias_sd_m, -2), bias];
    const last_s = poses.t_s[poses.t_s.length - 1] ?? 0;
    const first = span_s > 0 ? poses.t_s.findIndex((t_s) => t_s >= last_s - span_s) : 0;
    this.height.set(columns.map((column) => column.slice(Math.max(0, first))));
    this.bias.set(of_bias.map((column) => column.slice(Math.max(0, first))));
  }

  /** Leaves out the lower chart, where no bias is estimated. */
  hide_bias(): void {
    this.bias.root.hidden = true;
  }

  /** Marks a time in both; null: none. */
  mark(t_s: number | null): void {
    this.height.mark(t_s);
    this.bias.mark(t_s);
  }

  reset_zoom(): void {
    this.height.reset_zoom();
    this.bias.reset_zoom();
  }
}
