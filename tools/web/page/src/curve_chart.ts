// SPDX-License-Identifier: BSD-3-Clause
// Curves, points and bands: zoom by dragging, double click for all, values under the cursor.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { CurveChartData } from './chart_data';
import { colour_of, kAxisFont, number_text, Readout, scaled, swatch, themed_axis } from './chart_style';
import { element, on_theme_change, style_value } from './dom';

const kLogarithmic = 3;  // uPlot's scale distribution
const kFill = 0.14;      // opacity of the area below a stepped curve

export class CurveChart {
  readonly root = element('div', 'curve-chart');
  private plot: uPlot | null = null;
  private readonly shown: boolean[];
  private readonly readout = new Readout();

  /** Charts with the same `sync` share a cursor. */
  constructor(private readonly data: CurveChartData, private readonly sync = '') {
    this.shown = data.curves.map(() => true);
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

  /** One table of all x: curves, the edges of the areas, the ends of the axis. Dots are drawn by a hook: their x may
   *  repeat. */
  private joined(): uPlot.AlignedData {
    const { curves, areas, x_range } = this.data;
    return uPlot.join([
      ...curves.map((curve): uPlot.AlignedData => [curve.x, curve.y]),
      ...areas.map((area): uPlot.AlignedData => [area.x, area.low, area.high]),
      ...(x_range ? [[x_range] as uPlot.AlignedData] : []),
    ]);
  }

  private options(width: number, height: number): uPlot.Options {
    const { curves, areas, x_label, y_label, y_range, logarithmic } = this.data;
    const distr = logarithmic ? kLogarithmic : undefined;
    const edge = curves.length + 1;
    return {
      width, height,
      scales: {
        x: { time: false, distr },
        y: { distr, range: logarithmic ? undefined : (_, low, high) => y_range ?? padded(low, high) },
      },
      cursor: { drag: { x: true, y: true, uni: 30, dist: 6 }, points: { size: 5 }, sync: this.sync ? { key: this.sync } : undefined },
      legend: { show: false },
      axes: [{ ...themed_axis(x_label), size: 26 }, { ...themed_axis(y_label), size: 52 }],
      series: [
        {},
        ...curves.map((curve, i): uPlot.Series => ({
          label: curve.name, stroke: () => colour_of(curve.colour), width: curve.width, dash: curve.dash, show: this.shown[i],
          points: { show: false }, spanGaps: false,
          ...(curve.stepped ? { paths: uPlot.paths.stepped!({ align: 1 }), fill: () => faint(colour_of(curve.colour)) } : {}),
        })),
        ...areas.flatMap((): uPlot.Series[] => [{ width: 0, points: { show: false } }, { width: 0, points: { show: false } }]),
      ],
      bands: areas.map((area, i) => ({ series: [edge + 2 * i + 1, edge + 2 * i], fill: () => colour_of(area.colour) })),
      plugins: [{ hooks: { ready: [(plot) => this.readout.attach(plot)], setCursor: [(plot) => this.read(plot)] } }],
      hooks: { drawClear: [(plot) => this.shade_spans(plot)], drawAxes: [(plot) => this.draw_dots(plot)] },
    };
  }

  /** Values under the cursor. */
  private read(plot: uPlot): void {
    const { left, idx } = plot.cursor;
    if (left === undefined || left < 0 || idx === null || idx === undefined) return this.readout.hide();
    const { curves, x_unit, y_unit, y_decimals, spans } = this.data;
    const x = plot.data[0][idx];
    const rows = curves.map((curve, i) => ({ curve, value: this.shown[i] ? value_near(plot.data[i + 1], idx) : null }))
      .filter((row) => row.value !== null)
      .map(({ curve, value }) => element('div', '', swatch(curve.colour), `${curve.name.split(':')[0]} `, element('b', '', `${number_text(value!, y_decimals)} ${y_unit}`)));
    const where = spans.filter((span) => span.label && span.from <= x && x <= span.to).map((span) => `, ${span.label}`);
    this.readout.show(plot, left, element('div', 'at', `${x_text(x)} ${x_unit}${where.join('')}`), ...rows);
  }

  private shade_spans(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.textAlign = 'center';
    ctx.textBaseline = 'alphabetic';
    ctx.font = scaled(kAxisFont);
    for (const { from, to, label } of this.data.spans) {
      const begin = Math.max(bbox.left, plot.valToPos(from, 'x', true));
      const end = Math.min(bbox.left + bbox.width, plot.valToPos(to, 'x', true));
      if (end <= begin) continue;
      ctx.fillStyle = style_value('--raised');
      ctx.fillRect(begin, bbox.top, end - begin, bbox.height);
      if (ctx.measureText(label).width > end - begin) continue;
      ctx.fillStyle = style_value('--muted');
      ctx.fillText(label, (begin + end) / 2, bbox.top + 14 * devicePixelRatio);
    }
    ctx.restore();
  }

  private draw_dots(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const size = 2 * devicePixelRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.globalAlpha = 0.6;
    for (const dots of this.data.dots) {
      ctx.fillStyle = colour_of(dots.colour);
      dots.x.forEach((x, i) => {
        const y = dots.y[i];
        if (y !== null) ctx.fillRect(plot.valToPos(x, 'x', true) - size / 2, plot.valToPos(y, 'y', true) - size / 2, size, size);
      });
    }
    ctx.restore();
  }
}

function faint(colour: string): string {
  return /^#[0-9a-f]{6}$/i.test(colour) ? colour + Math.round(255 * kFill).toString(16) : 'transparent';
}

function x_text(x: number): string {
  return Math.abs(x) >= 10 || x === 0 ? number_text(x, 1) : String(Number(x.toPrecision(3))).replace('-', '−');
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
