// SPDX-License-Identifier: BSD-3-Clause
// A box plot: one row a box, drawn by a hook of uPlot, which does axes, grid, sizes and cursor.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { Box, BoxChartData } from './chart_data';
import { colour_of, kAxisFont, kNarrowPx, number_text, Readout, scaled, themed_axis } from './chart_style';
import { element, on_theme_change, style_value } from './dom';

const kRowPx = 46;
const kBoxPx = 22;
const kCapPx = 7;
const kNamePx = 8;  // a box below its name stands so much lower
const kLogarithmic = 3;  // uPlot's scale distribution

export class BoxChart {
  readonly root = element('div', 'box-chart');
  private plot: uPlot | null = null;
  private readonly readout = new Readout();

  constructor(private readonly data: BoxChartData) {
    new ResizeObserver(() => this.resize()).observe(this.root);
    on_theme_change(() => this.plot?.redraw());
  }

  /** At narrow widths the names stand above the boxes, so that the axes change: the plot is made again. */
  private resize(): void {
    const width = this.root.clientWidth;
    if (width < 50 || (this.plot && this.plot.width === width)) return;
    this.plot?.destroy();
    const columns: uPlot.AlignedData = [this.data.range, [null, null]];
    this.plot = new uPlot(this.options(width), columns, this.root);
  }

  /** Rows stand at y = 0, −1, −2 … */
  private options(width: number): uPlot.Options {
    const { rows, range, x_label, logarithmic } = this.data;
    const is_narrow = width < kNarrowPx;
    const names = rows.map((row) => row.name);
    const medians = rows.map((row) => this.value_text(row.median));
    const plain: uPlot.Axis = { ...themed_axis(), stroke: () => style_value('--ink'), grid: { show: false }, splits: () => rows.map((_, i) => -i) };
    return {
      width, height: rows.length * kRowPx + 52,
      padding: [6, 6, 0, 0],
      scales: {
        x: { time: false, range: () => range, distr: logarithmic ? kLogarithmic : undefined },
        y: { range: () => [0.5 - rows.length, 0.5] },
      },
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      legend: { show: false },
      axes: [
        { ...themed_axis(x_label), size: 26 },
        { ...plain, show: !is_narrow, values: () => names, size: text_px(names) + 14 },
        { ...plain, side: 1, values: () => medians, size: text_px(medians) + 14 },
      ],
      series: [{}, { show: true, points: { show: false } }],
      hooks: {
        draw: [(plot) => rows.forEach((row, i) => draw_box(plot, row, i, is_narrow))],
        ready: [(plot) => this.readout.attach(plot)],
        setCursor: [(plot) => this.read(plot)],
      },
    };
  }

  private read(plot: uPlot): void {
    const { left, top } = plot.cursor;
    const row = top === undefined || top < 0 ? undefined : this.data.rows[Math.floor(top / (plot.over.clientHeight / this.data.rows.length))];
    if (!row || row.median === null || left === undefined) return this.readout.hide();
    const line = (label: string, ...values: (number | undefined)[]) =>
      element('div', '', `${label} `, element('b', '', values.map((value) => this.value_text(value ?? null)).join(' – ')));
    this.readout.show(plot, left, element('div', 'at', row.name), line('median', row.median), line('quartiles', row.q25, row.q75), line('5 % – 95 %', row.p05, row.p95));
  }

  private value_text(value: number | null): string {
    return value === null ? 'no data' : `${number_text(value, this.data.decimals)} ${this.data.unit}`;
  }
}

function draw_box(plot: uPlot, row: Box, index: number, is_named: boolean): void {
  const { ctx, bbox } = plot;
  const dpr = devicePixelRatio;
  const x = (value: number) => Math.min(Math.max(plot.valToPos(value, 'x', true), bbox.left), bbox.left + bbox.width);
  const middle = plot.valToPos(-index, 'y', true);
  const y = is_named ? middle + kNamePx * dpr : middle;
  if (is_named) draw_name(plot, row.name, y - (kBoxPx / 2 + 5) * dpr);
  if (row.median === null) return;
  const half = (kBoxPx / 2) * dpr;
  const line = (x0: number, y0: number, x1: number, y1: number, width: number) => {
    ctx.lineWidth = width * dpr;
    ctx.beginPath();
    ctx.moveTo(x0, y0);
    ctx.lineTo(x1, y1);
    ctx.stroke();
  };
  const [p05, q25, median, q75, p95] = [row.p05!, row.q25!, row.median, row.q75!, row.p95!].map(x);
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = colour_of(row.colour);
  line(p05, y, q25, y, 1.6);
  line(q75, y, p95, y, 1.6);
  // No cap where a whisker leaves a logarithmic axis.
  if (row.p05! >= plot.scales.x.min!) line(p05, y - kCapPx * dpr, p05, y + kCapPx * dpr, 1.6);
  line(p95, y - kCapPx * dpr, p95, y + kCapPx * dpr, 1.6);
  ctx.globalAlpha = 0.28;
  ctx.fillRect(q25, y - half, q75 - q25, 2 * half);
  ctx.globalAlpha = 1;
  ctx.lineWidth = 1.6 * dpr;
  ctx.strokeRect(q25, y - half, q75 - q25, 2 * half);
  line(median, y - half, median, y + half, 3.2);
  ctx.restore();
}

function draw_name({ ctx, bbox }: uPlot, name: string, y: number): void {
  ctx.save();
  ctx.font = scaled(kAxisFont);
  ctx.textAlign = 'left';
  ctx.textBaseline = 'alphabetic';
  ctx.fillStyle = style_value('--ink');
  ctx.fillText(name, bbox.left + 2 * devicePixelRatio, y);
  ctx.restore();
}

/** Width of the longest text. */
function text_px(texts: string[]): number {
  const context = document.createElement('canvas').getContext('2d');
  if (!context) return 120;
  context.font = kAxisFont;
  return Math.max(40, ...texts.map((text) => context.measureText(text).width));
}
