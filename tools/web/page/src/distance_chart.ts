// SPDX-License-Identifier: BSD-3-Clause
// Curves along the way: zoom by dragging, double click for all, a cursor shared by all charts of the page.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { element, on_theme_change, style_value } from './dom';

export interface Curve {
  label: string;
  /** A colour, or the name of a custom property, "--ink". */
  colour: string;
  dash: number[];
  width: number;
  distance_m: number[];
  value_m: number[];
}

const kAxisFont = '11px system-ui, sans-serif';

function colour_of(name: string): string {
  return name.startsWith('--') ? style_value(name) : name;
}

/** The same for a style sheet, which follows the theme by itself. */
export function css_colour(name: string): string {
  return name.startsWith('--') ? `var(${name})` : name;
}

export class DistanceChart {
  readonly root = element('div', 'distance-chart');
  private plot: uPlot | null = null;
  private readonly shown: boolean[];

  constructor(private readonly curves: Curve[], private readonly y_label: string, private readonly flat: [number, number][]) {
    this.shown = curves.map(() => true);
    new ResizeObserver(() => this.resize()).observe(this.root);
    on_theme_change(() => this.plot?.redraw());
  }

  /** Shows or hides a curve; the others keep their colours, the axis fits what is shown. */
  show(index: number, is_shown: boolean): void {
    this.shown[index] = is_shown;
    this.plot?.setSeries(index + 1, { show: is_shown });
  }

  private resize(): void {
    const { clientWidth: width, clientHeight } = this.root;
    if (width < 50) return;
    const height = clientHeight - 4;
    if (this.plot) this.plot.setSize({ width, height });
    else this.plot = new uPlot(this.options(width, height), this.joined(), this.root);
  }

  private joined(): uPlot.AlignedData {
    return uPlot.join(this.curves.map((curve) => [curve.distance_m, curve.value_m]));
  }

  private options(width: number, height: number): uPlot.Options {
    const axis = { stroke: () => style_value('--muted'), font: kAxisFont, ticks: { show: false }, grid: { stroke: () => style_value('--line'), width: 1 } };
    return {
      width, height,
      scales: { x: { time: false }, y: { range: (_, low, high) => padded(low, high) } },
      cursor: { drag: { x: true, y: true, uni: 30, dist: 6 }, points: { size: 5 }, sync: { key: 'way' } },
      legend: { show: false },
      axes: [
        { ...axis, values: (_, ticks) => ticks.map((tick) => `${tick} m`), size: 26 },
        { ...axis, label: this.y_label, labelFont: kAxisFont, labelSize: 16, labelGap: 0, size: 52 },
      ],
      series: [
        {},
        ...this.curves.map((curve, i): uPlot.Series => ({
          label: curve.label, stroke: () => colour_of(curve.colour), width: curve.width, dash: curve.dash, show: this.shown[i],
          points: { show: false }, spanGaps: true,
        })),
      ],
      plugins: [this.readout()],
      hooks: { drawClear: [(plot) => this.shade_flat(plot)] },
    };
  }

  /** Values under the cursor, in a box that follows it. */
  private readout(): uPlot.Plugin {
    const box = element('div', 'readout');
    return {
      hooks: {
        ready: [(plot) => { plot.over.append(box); box.hidden = true; }],
        setCursor: [(plot) => {
          const { left, idx } = plot.cursor;
          box.hidden = left === undefined || left < 0 || idx === null || idx === undefined;
          if (box.hidden) return;
          const rows = this.curves.map((curve, i) => ({ curve, value: this.shown[i] ? value_near(plot.data[i + 1], idx!) : null }))
            .filter((row) => row.value !== null)
            .map(({ curve, value }) => {
              const swatch = element('i', 'swatch');
              swatch.style.background = css_colour(curve.colour);
              return element('div', '', swatch, `${curve.label} `, element('b', '', `${value!.toFixed(3).replace('-', '−')} m`));
            });
          box.replaceChildren(element('div', 'at', `${plot.data[0][idx!].toFixed(1)} m`), ...rows);
          const is_right = left! > plot.over.clientWidth / 2;
          box.style.left = is_right ? 'auto' : `${left! + 14}px`;
          box.style.right = is_right ? `${plot.over.clientWidth - left! + 14}px` : 'auto';
        }],
      },
    };
  }

  private shade_flat(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.fillStyle = style_value('--raised');
    for (const [from, to] of this.flat) {
      const begin = Math.max(bbox.left, plot.valToPos(from, 'x', true));
      const end = Math.min(bbox.left + bbox.width, plot.valToPos(to, 'x', true));
      if (end > begin) ctx.fillRect(begin, bbox.top, end - begin, bbox.height);
    }
    ctx.restore();
  }
}

function padded(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !Number.isFinite(low)) return [0, 1];
  const margin = 0.06 * Math.max(high - low, 0.02);
  return [low - margin, high + margin];
}

/** The value at a row, or the nearest before it: the curves have rows of their own. */
function value_near(column: ArrayLike<number | null | undefined>, row: number): number | null {
  for (let i = row; i >= Math.max(0, row - 50); --i) {
    const value = column[i];
    if (value !== null && value !== undefined) return value;
  }
  return null;
}
