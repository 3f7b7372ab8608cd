// SPDX-License-Identifier: BSD-3-Clause
// The parts of a report that a reader moves: curves along the way with methods to switch on and off, and the map of one
// method in three dimensions, floor by floor. The rest of the report needs no script.
import './report.css';
import { button, element } from './dom';
import { css_colour, DistanceChart, type Curve } from './distance_chart';
import { FloorSlicer } from './floor_slicer';
import { decode_map } from './map_chunks';
import { MapView } from './map_view';
import type { Method, ReportData } from './report_data';

function data_of_page(): ReportData {
  return JSON.parse(document.getElementById('isobar-report')?.textContent ?? '') as ReportData;
}

function curve_of(method: Method, value_m: number[]): Curve {
  return { label: method.name, colour: method.colour, dash: method.dash, width: 1.8, distance_m: method.distance_m, value_m };
}

/** A chip for each method; a click shows or hides it, with Shift or Ctrl it alone is shown. */
function method_chips(methods: Method[], show: (index: number, is_shown: boolean) => void): HTMLElement {
  const shown = methods.map(() => true);
  const chips = methods.map((method, index) => {
    const chip = button('', 'chip', () => {});
    const swatch = element('i', 'swatch');
    swatch.style.background = css_colour(method.colour);
    chip.append(swatch, method.name);
    if (method.verdict !== 'ok') {
      chip.append(element('small', '', method.verdict));
      chip.title = method.reason;
    }
    chip.addEventListener('click', (event) => {
      if (event.shiftKey || event.ctrlKey) shown.fill(false);
      shown[index] = !shown[index];
      apply();
    });
    return chip;
  });
  const apply = () => chips.forEach((chip, i) => {
    chip.setAttribute('aria-pressed', String(shown[i]));
    show(i, shown[i]);
  });
  apply();
  const group = element('div', 'chips', ...chips);
  group.setAttribute('role', 'group');
  group.setAttribute('aria-label', 'Methods');
  return group;
}

function figure(title: string, body: HTMLElement, caption: string): HTMLElement {
  return element('figure', 'live', element('h2', '', title), body, element('figcaption', '', caption));
}

function curves(data: ReportData, target: HTMLElement): void {
  const errors = new DistanceChart(data.methods.map((m) => curve_of(m, m.error_m)), 'height error m', data.flat);
  const heights = new DistanceChart(
    [...data.methods.map((m) => curve_of(m, m.z_m)),
      { label: 'reference', colour: '--muted', dash: [6, 4], width: 1.4, distance_m: data.reference.distance_m, value_m: data.reference.z_m }],
    'height m', data.flat);
  heights.root.classList.add('low');
  const shading = data.flat.length > 0 ? ' Shaded: flat segments.' : '';
  target.append(
    figure('Height error along the way', element('div', '', method_chips(data.methods, (index, is_shown) => {
      errors.show(index, is_shown);
      heights.show(index, is_shown);
    }), errors.root), `Estimate minus reference; all start poses coincide.${shading} Drag to zoom, double click for all.`),
    figure('Height along the way', heights.root, 'Dashed: the reference.'));
}

/** Calls back once, when a part comes near the window or is to be printed. */
function when_near(part: HTMLElement, callback: () => void): void {
  let is_done = false;
  const once = () => {
    if (is_done) return;
    is_done = true;
    watcher.disconnect();
    removeEventListener('beforeprint', once);
    callback();
  };
  // After the next frame: text and curves are painted first.
  const watcher = new IntersectionObserver((entries) => {
    if (entries.some((entry) => entry.isIntersecting)) requestAnimationFrame(() => setTimeout(once, 0));
  }, { rootMargin: '600px' });
  watcher.observe(part);
  addEventListener('beforeprint', once);
}

/** The place of the map; what fills it, and takes a second on a weak machine, begins when a reader comes near. */
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
  when_near(box, () => {
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
  curves(data, target);
  map_of(data, target);
  document.body.classList.add('has-script');
}
