// SPDX-License-Identifier: BSD-3-Clause
// The counters of a run: what was received, lost and refused. Those at zero come only when asked for.
import { button, element, panel, scrolls, set_text } from './dom';
import { count } from './format';
import type { ViewData } from './view_data';

/** "base_barometer: good rows" is read "base barometer: rows read". */
function title_of(name: string): string {
  return name.replaceAll('_', ' ').replace(/good rows$/, 'rows read');
}

export function counters_table(counters: ViewData['counters']): HTMLElement {
  const { root, head, body } = panel('Counters', 'counters');
  const rows = element('tbody', '');
  let all = false;
  const show = () => {
    const shown = counters.filter((counter) => all || counter.count > 0);
    rows.replaceChildren(...shown.map((counter) => {
      const name = element('th', '', title_of(counter.name), counter.message ? element('span', 'message', counter.message) : null);
      name.scope = 'row';
      return element('tr', '', name, element('td', '', count(counter.count)));
    }));
    set_text(toggle, all ? 'Show less' : `Show all ${counters.length}`);
  };
  const toggle = button('', 'quiet', () => {
    all = !all;
    show();
  });
  show();
  head.append(toggle);
  body.append(scrolls(element('div', 'scroll', element('table', 'figures', rows)), 'Counters'));
  return root;
}
