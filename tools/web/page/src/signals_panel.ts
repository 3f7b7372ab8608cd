// SPDX-License-Identifier: BSD-3-Clause
// Curves of a recording's sensors, one chart a signal, all with one cursor and one zoom.
import { Chart } from './chart';
import { element, panel } from './dom';
import type { Signal } from './view_data';

const kColours = ['--accent', '--air', '--third'];

export class SignalsPanel {
  readonly root: HTMLElement;
  private readonly charts: Chart[] = [];

  constructor(signals: Signal[], on_pick: (t_s: number) => void) {
    const { root, body } = panel('Sensor signals', 'signals');
    this.root = root;
    for (const signal of signals) {
      const chart = new Chart({
        y_label: signal.unit,
        sync: 'signals',
        series: signal.series.map((one, i) => ({ label: one.name, colour: kColours[i % kColours.length], unit: signal.unit, decimals: signal.unit === 'Pa' ? 1 : 3, width: 1 })),
      });
      chart.on_pick = on_pick;
      this.charts.push(chart);
      body.append(element('figure', '', element('figcaption', '', signal.name), chart.root));
      chart.set([signal.t_s, ...signal.series.map((one) => one.values)]);
    }
  }

  mark(t_s: number): void {
    for (const chart of this.charts) chart.mark(t_s);
  }
}
