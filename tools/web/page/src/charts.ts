// SPDX-License-Identifier: BSD-3-Clause
// Draws the charts of a report: each stands in it as data, beside the place that it takes.
import './charts.css';
import { BoxChart } from './box_chart';
import type { ChartData, CurveChartData } from './chart_data';
import { CurveChart } from './curve_chart';
import { element } from './dom';
import { legend_chips } from './legend';

function curves_with_legend(data: CurveChartData): HTMLElement {
  const chart = new CurveChart(data);
  const named = data.curves.flatMap((curve, index) => (curve.name ? [{ ...curve, index }] : []));
  const legend = named.length > 1 ? legend_chips(named, (i, is_shown) => chart.show(named[i].index, is_shown)) : null;
  return element('div', '', legend, chart.root);
}

for (const script of document.querySelectorAll('script.isobar-chart')) {
  const place = script.parentElement?.querySelector('.chart-place');
  if (!place) continue;
  const data = JSON.parse(script.textContent ?? '') as ChartData;
  place.setAttribute('role', 'figure');
  place.replaceChildren(data.kind === 'boxes' ? new BoxChart(data).root : curves_with_legend(data));
}
