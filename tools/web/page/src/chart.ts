// SPDX-License-Identifier: BSD-3-Clause
// A uPlot chart that fills its element, takes its colours from the style sheet, zooms by dragging and follows one time
// with the other views. What is drawn is the caller's.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { kNarrowPx, themed_axis } from './chart_style';
import { element, on_theme_change, style_value } from './dom';
import { span } from './format';

export interface ChartSeries {
  label: string;
  /** Name of a custom property of the style sheet: "--accent". */
  colour: string;
  unit: string;
  decimals: number;
  width?: number;
  dash?: number[];
  /** Drawn, but not in the legend: an edge of a band. */
  hidden_label?: boolean;
}

export interface ChartOptions {
  series: ChartSeries[];
  /** Pairs of series between which the area is filled, and its colour. */
  bands?: { between: [number, number]; colour: string }[];
  y_label: string;
  /** Smallest extent of the y axis, so that noise at rest does not fill the chart. */
  least_extent?: number;
  /** Charts of one name share cursor and zoom. */
  sync?: string;
}

export class Chart {
  readonly root = element('div', 'chart');
  /** Called with the time under a click. */
  on_pick: (t_s: number) => void = () => {};
  private plot: uPlot | null = null;
  private data: uPlot.AlignedData;
  private is_zoomed = false;
  private marked_s: number | null = null;
  private readonly mark_line = element('div', 'chart-mark');

  constructor(private readonly options: ChartOptions) {
    this.data = [[], ...options.series.map(() => [])] as unknown as uPlot.AlignedData;
    new ResizeObserver(() => this.resize()).observe(this.root);
    on_theme_change(() => this.plot?.redraw());
  }

  /** Columns in the order of the series; the first one is the time [s]. A zoom stays. */
  set(data: (readonly (number | null)[])[]): void {
    this.data = data as unknown as uPlot.AlignedData;
    if (!this.plot) return;
    this.plot.setData(this.data, !this.is_zoomed);
    if (this.is_zoomed) this.plot.redraw();
    this.show_values(this.plot);
  }

  /** Marks a time by a line; null: none. */
  mark(t_s: number | null): void {
    if (t_s === this.marked_s) return;
    this.marked_s = t_s;
    if (!this.plot) return;
    this.place_mark(this.plot);
    this.show_values(this.plot);
  }

  reset_zoom(): void {
    this.is_zoomed = false;
    this.plot?.setData(this.data, true);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (width < 50 || height < 50) return;
    const size = { width, height: height - this.legend_px() };
    if (this.plot) {
      this.plot.setSize(size);
    } else {
      this.plot = new uPlot(this.plot_options(size), this.data, this.root);
    }
  }

  /** As in the style sheet: a legend that grew with its values would move the chart. */
  private legend_px(): number {
    const is_narrow = this.root.clientWidth < kNarrowPx;
    this.root.classList.toggle('narrow', is_narrow);
    return is_narrow ? 46 : 26;
  }

  private plot_options({ width, height }: { width: number; height: number }): uPlot.Options {
    const { series, bands, y_label } = this.options;
    return {
      width, height,
      scales: { x: { time: false }, y: { range: (_, low, high) => this.padded(low, high) } },
      cursor: {
        drag: { x: true, y: false, dist: 6 },
        points: { size: 6 },
        sync: this.options.sync ? { key: this.options.sync, setSeries: false } : undefined,
      },
      legend: { live: true },
      axes: [
        { ...themed_axis(), values: (_, ticks) => ticks.map((tick) => span(tick, ticks.length > 1 && ticks[1] - ticks[0] < 1 ? 1 : 0)), size: 26 },
        { ...themed_axis(y_label), labelSize: 16, size: 56 },
      ],
      series: [
        { label: 'time', value: (_, t_s) => (t_s === null || t_s === undefined ? '–' : span(t_s, 1)) },
        ...series.map((one): uPlot.Series => ({
          label: one.label,
          stroke: () => style_value(one.colour),
          width: one.width ?? 1.5,
          dash: one.dash,
          points: { show: false },
          spanGaps: false,
          class: one.hidden_label ? 'no-legend' : undefined,
          value: (_, value) => (value === null || value === undefined ? '–' : `${value.toFixed(one.decimals).replace('-', '−')} ${one.unit}`),
        })),
      ],
      bands: (bands ?? []).map((band) => ({ series: band.between, fill: () => style_value(band.colour) })),
      hooks: {
        setSelect: [(plot) => { if (plot.select.width > 0) this.is_zoomed = true; }],
        draw: [(plot) => this.place_mark(plot)],
        ready: [(plot) => this.listen(plot)],
        // When the pointer has left, uPlot empties the legend.
        setCursor: [(plot) => { if ((plot.cursor.left ?? -1) < 0) queueMicrotask(() => this.show_values(plot)); }],
      },
    };
  }

  private padded(low: number | null, high: number | null): [number, number] {
    if (low === null || high === null || !Number.isFinite(low)) return [0, 1];
    const extent = Math.max(high - low, this.options.least_extent ?? 0) || 1;
    const middle = (low + high) / 2;
    return [middle - 0.56 * extent, middle + 0.56 * extent];
  }

  private listen(plot: uPlot): void {
    plot.over.append(this.mark_line);
    this.place_mark(plot);
    this.show_values(plot);
    plot.over.addEventListener('dblclick', () => this.reset_zoom());
    let pressed_px = 0;
    plot.over.addEventListener('mousedown', (event) => (pressed_px = event.clientX));
    plot.over.addEventListener('click', (event) => {
      if (Math.abs(event.clientX - pressed_px) > 5) return;
      const { left } = plot.over.getBoundingClientRect();
      this.on_pick(plot.posToVal(event.clientX - left, 'x'));
    });
  }

  /** The legend tells the values at the marked time, or the newest, while no pointer asks for others. */
  private show_values(plot: uPlot): void {
    const last = plot.data[0].length - 1;
    if (last < 0 || (plot.cursor.left ?? -1) >= 0) return;
    let row = this.marked_s === null ? last : plot.valToIdx(this.marked_s);
    // The newest that is not after it, as everywhere on the page.
    if (row > 0 && this.marked_s !== null && plot.data[0][row] > this.marked_s) --row;
    plot.setLegend({ idx: row }, false);
  }

  /** Moves the line over the chart, which is not drawn anew for it. */
  private place_mark(plot: uPlot): void {
    const x = this.marked_s === null ? NaN : plot.valToPos(this.marked_s, 'x');
    const is_inside = x >= 0 && x <= plot.over.clientWidth;
    this.mark_line.hidden = !is_inside;
    if (is_inside) this.mark_line.style.transform = `translateX(${x.toFixed(1)}px)`;
  }
}
