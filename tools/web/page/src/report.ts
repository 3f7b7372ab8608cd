// SPDX-License-Identifier: BSD-3-Clause
// The head of a comparison of runs: curves along the way with methods to switch on and off, and the map of one method in
// three dimensions, floor by floor. Its other charts are those of every report.
import './report.css';
import type { Curve } from './chart_data';
import './charts';
import { CurveChart } from './curve_chart';
import { button, element } from './dom';
import { FloorSlicer } from './floor_slicer';
import { legend_chips } from './legend';
import { decode_map } from './map_chunks';
import { MapView } from './map_view';
import type { Line, ReportData } from './report_data';

function data_of_page(): ReportData {
  return JSON.parse(document.getElementById('isobar-report')?.textContent ?? '') as ReportData;
}

const kWay = { kind: 'curves', x_label: 'travelled distance [m]', x_unit: 'm', y_unit: 'm', y_decimals: 3, areas: [], dots: [], x_range: null, y_range: null, logarithmic: false } as const;

function curve_of(line: Line, x: number[], y: (number | null)[]): Curve {
  return { name: line.name, colour: line.colour, dash: line.dash, width: line.width, x, y };
}

/** A chart along the way, with the flat segments shaded. */
function way_chart(data: ReportData, y_label: string, curves: Curve[]): CurveChart {
  const spans = data.flat.map(([from, to]) => ({ from, to, label: '' }));
  return new CurveChart({ ...kWay, areas: [], dots: [], y_label, curves, spans }, 'way');
}

function figure(title: string, body: HTMLElement, caption: string): HTMLElement {
  return element('figure', 'live', element('h2', '', title), body, element('figcaption', '', caption));
}

function curves(data: ReportData, target: HTMLElement): void {
  const errors = way_chart(data, 'height error [m]', data.methods.map((m) => curve_of(m, m.distance_m, m.error_m)));
  const others = data.altimeter ? [data.altimeter, data.reference] : [data.reference];
  const heights = way_chart(data, 'height [m]', [...data.methods, ...others].map((m) => curve_of(m, m.distance_m, m.z_m)));
  heights.root.classList.add('low');
  const entries = data.methods.map((m) => ({ ...m, remark: m.verdict === 'ok' ? '' : m.verdict }));
  const shading = data.flat.length > 0 ? ' Shaded: flat segments.' : '';
  target.append(
    figure('Height error along the way', element('div', '', legend_chips(entries, (index, is_shown) => {
      errors.show(index, is_shown);
      heights.show(index, is_shown);
    }), errors.root), `Estimate minus reference; all start poses coincide.${shading} Drag to zoom, double click for all.`),
    figure('Height along the way', heights.root, data.altimeter ? 'Dashed: the reference; dotted: the altimeter.' : 'Dashed: the reference.'));
}

/** Text and curves have been painted by then [ms]. */
const kLaterMs = 300;

/** Calls back once: later, or before the page is printed. */
function later(callback: () => void): void {
  const once = () => {
    clearTimeout(timer);
    removeEventListener('beforeprint', once);
    callback();
  };
  const timer = setTimeout(once, kLaterMs);
  addEventListener('beforeprint', once);
}

/** The place of the map; what fills it, and takes a second on a weak machine, begins after text and curves. */
function map_of(data: ReportData, target: HTMLElement): void {
  const indices = data.methods.map((_, index) => index).filter((index) => data.methods[index].has_map);
  if (indices.length === 0) return;
  const place = element('div', 'map-view');
  const group = element('div', 'chips');
  const slicer = new FloorSlicer();
  slicer.set_floors(data.floors);
  const chips = indices.map((index) => button(data.methods[index].name, 'chip', () => {}));
  const from_top = button('From above', 'chip', () => {});
  group.append(...(chips.length > 1 ? chips : []), from_top);
  const box = element('div', 'map-box', group, place, slicer.root);
  target.append(figure('The map', box,
    'Coloured by height. Drag to turn, wheel or pinch to zoom, right button or two fingers to move; buttons show one floor. Thick line: the estimate; thin line: the reference.'));
  later(() => {
    let view: MapView;
    try {
      view = new MapView();
    } catch {
      box.replaceChildren(element('p', 'no-map', 'This browser has no WebGL, which draws the map.'));
      return;
    }
    place.replaceWith(view.root);
    view.on_range = (range_m) => slicer.set_range(range_m);
    slicer.on_slice = (slice_m) => view.set_slice(slice_m);
    slicer.on_cut = (floors_m) => view.cut_above(floors_m);
    slicer.tell();
    const choose = (chosen: number) => {
      const text = document.getElementById(`isobar-map-${chosen}`)?.textContent ?? '';
      const method = data.methods[chosen];
      view.clear();
      view.apply(decode_map(Uint8Array.from(atob(text.trim()), (byte) => byte.charCodeAt(0)).buffer));
      view.set_path(method, method);
      view.set_other_path(data.reference);
      chips.forEach((chip, i) => chip.setAttribute('aria-pressed', String(indices[i] === chosen)));
    };
    chips.forEach((chip, i) => chip.addEventListener('click', () => choose(indices[i])));
    from_top.addEventListener('click', () => view.fit(true));
    choose(indices.includes(data.main) ? data.main : indices[0]);
  });
}

const target = document.getElementById('isobar-report-view');
if (target) {
  const data = data_of_page();
  target.replaceChildren();
  curves(data, target);
  map_of(data, target);
}
