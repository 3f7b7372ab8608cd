// SPDX-License-Identifier: BSD-3-Clause
// The frame of the page: what stands where. Every part has its place from the start, so that nothing moves when data
// come.
import { button, element, panel } from './dom';
import { FloorSlicer } from './floor_slicer';
import { HeightChart } from './height_chart';
import { HealthLights, SummaryLight } from './health_lights';
import { MapView } from './map_view';
import { PoseReadout } from './pose_readout';
import { Rates } from './rates';
import { SettingsTable } from './settings_table';
import type { ViewData } from './view_data';

export interface Layout {
  summary: SummaryLight;
  pose: PoseReadout;
  map: MapView | null;
  map_note: HTMLElement;
  map_foot: HTMLElement;
  slicer: FloorSlicer;
  height: HeightChart;
  height_head: HTMLElement;
  health: HealthLights;
  rates: Rates;
  settings: SettingsTable;
  side: HTMLElement;
  below: HTMLElement;
  banner: HTMLElement;
}

function make_map(): MapView | null {
  try {
    return new MapView();
  } catch {
    return null;
  }
}

function map_panel(layout: Layout, is_live: boolean): HTMLElement {
  const { root, head, body } = panel('Map', 'map');
  const { map, slicer } = layout;
  if (map) {
    head.append(
      element('div', 'tools',
        button('3-D', 'quiet', () => map.fit()),
        button('Top', 'quiet', () => map.fit(true)),
        is_live ? follow_button(map) : null));
    map.on_range = (range) => slicer.set_range(range);
    slicer.on_slice = (slice_m) => map.set_slice(slice_m);
    slicer.on_cut = (floors_m) => map.cut_above(floors_m);
    body.append(map.root);
  } else {
    body.append(element('div', 'map-view'));
    layout.map_note.textContent = 'This browser does not draw WebGL: no map.';
  }
  body.append(layout.map_note, slicer.root, layout.map_foot);
  return root;
}

function follow_button(map: MapView): HTMLButtonElement {
  const made = button('Follow', 'quiet', () => {
    const follows = made.getAttribute('aria-pressed') !== 'true';
    made.setAttribute('aria-pressed', String(follows));
    map.set_follow(follows);
  });
  made.setAttribute('aria-pressed', 'false');
  return made;
}

/** Builds the page for this kind of view. */
export function make_layout(view: ViewData): Layout {
  const is_live = view.kind === 'live';
  const height = panel('Height', 'height');
  const layout: Layout = {
    summary: new SummaryLight(),
    pose: new PoseReadout(),
    map: make_map(),
    map_note: element('p', 'map-note'),
    map_foot: element('div', 'map-foot'),
    slicer: new FloorSlicer(),
    height: new HeightChart(),
    height_head: height.head,
    health: new HealthLights(),
    rates: new Rates(is_live),
    settings: new SettingsTable(),
    side: element('div', 'side'),
    below: element('div', 'below'),
    banner: element('div', 'banner'),
  };
  layout.banner.setAttribute('role', 'alert');
  layout.banner.hidden = true;
  height.head.append(element('span', 'hint', 'drag to zoom, double click for all'));
  height.body.append(layout.height.root);
  layout.side.append(layout.health.root, layout.rates.root);
  layout.below.append(layout.settings.root);
  document.title = `${view.title} – Isobar`;
  document.body.className = view.kind;
  document.body.replaceChildren(
    element('header', 'top', element('div', 'brand', element('b', '', 'isobar'), element('span', 'kind', view.kind), element('span', 'title', view.title)), layout.summary.root),
    layout.pose.root,
    element('main', '', map_panel(layout, is_live), layout.side, height.root, layout.below),
    element('footer', '', `Isobar ${view.version}`),
    layout.banner);
  return layout;
}
