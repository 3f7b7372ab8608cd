// SPDX-License-Identifier: BSD-3-Clause
// The counters of a run: what was received, lost and refused.
import { element, panel } from './dom';
import { count } from './format';
import type { ViewData } from './view_data';

export function counters_table(counters: ViewData['counters']): HTMLElement {
  const { root, body } = panel('Counters', 'counters');
  const rows = counters.map((counter) => {
    const name = element('th', '', counter.name);
    name.scope = 'row';
    return element('tr', '', name, element('td', '', count(counter.count)), element('td', 'sentence', counter.message));
  });
  body.append(element('div', 'scroll', element('table', 'figures', element('tbody', '', ...rows))));
  return root;
}
