// SPDX-License-Identifier: BSD-3-Clause
// A chip for each curve; a click shows or hides it, with Shift or Ctrl it alone is shown.
import { swatch } from './chart_style';
import { button, element } from './dom';

export interface LegendEntry {
  name: string;
  colour: string;
  /** Beside the name, and why; empty: nothing. */
  remark?: string;
  reason?: string;
}

export function legend_chips(entries: LegendEntry[], show: (index: number, is_shown: boolean) => void): HTMLElement {
  const shown = entries.map(() => true);
  const chips = entries.map((entry, index) => {
    const chip = button('', 'chip', () => {});
    chip.append(swatch(entry.colour), entry.name);
    if (entry.remark) {
      chip.append(element('small', '', entry.remark));
      chip.title = entry.reason ?? '';
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
  group.setAttribute('aria-label', 'Curves');
  return group;
}
