// SPDX-License-Identifier: BSD-3-Clause
// Every setting in force and where its value comes from; what differs from the defaults first.
import { element, panel, scrolls, set_text } from './dom';
import type { Setting } from './view_data';

type Choice = 'changed' | 'basic' | 'all';

export class SettingsTable {
  readonly root: HTMLElement;
  private readonly table: HTMLElement;
  private readonly rows = element('tbody', '');
  private readonly search = element('input', 'search');
  private readonly choice = element('select', '');
  private readonly note = element('p', 'note');
  private settings: Setting[] = [];

  constructor() {
    const { root, head, body } = panel('Configuration in force', 'settings');
    this.root = root;
    for (const [value, text] of [['changed', 'Differs from default'], ['basic', 'Basic'], ['all', 'All']]) {
      const option = element('option', '', text);
      option.value = value;
      this.choice.append(option);
    }
    this.choice.setAttribute('aria-label', 'Which settings');
    this.search.type = 'search';
    this.search.placeholder = 'Search';
    this.search.setAttribute('aria-label', 'Search the settings');
    head.append(this.choice, this.search);
    this.table = scrolls(element('div', 'scroll', element('table', 'settings-rows', element('thead', '', element('tr', '', ...['Setting', 'Value', 'From'].map((text) => element('th', '', text)))), this.rows)), 'Settings');
    this.choice.addEventListener('change', () => this.show());
    this.search.addEventListener('input', () => this.show());
    body.append(this.note, this.table);
    this.show();
  }

  set(settings: Setting[]): void {
    this.settings = settings;
    this.show();
  }

  private is_shown(setting: Setting, words: string): boolean {
    if (words) return `${setting.key} ${setting.value} ${setting.doc}`.toLowerCase().includes(words);
    const choice = this.choice.value as Choice;
    return choice === 'all' || (choice === 'basic' ? setting.basic : !setting.is_default);
  }

  private show(): void {
    const words = this.search.value.trim().toLowerCase();
    const shown = this.settings.filter((setting) => this.is_shown(setting, words));
    this.rows.replaceChildren(...shown.map((setting) => {
      const key = element('th', '', setting.key);
      key.scope = 'row';
      key.title = setting.doc;
      const value = element('td', 'value', setting.value, setting.unit ? element('span', 'unit', ` ${setting.unit}`) : null);
      return element('tr', setting.is_default ? '' : 'changed', key, value, element('td', 'source', setting.source));
    }));
    const changed = this.settings.filter((setting) => !setting.is_default).length;
    const words_of = this.settings.length === 0
      ? 'The configuration is not known.'
      : `${this.settings.length} settings, ${changed} of them not the default; ${shown.length} shown.`;
    set_text(this.note, words_of);
    for (const part of [this.table, this.choice, this.search]) part.hidden = this.settings.length === 0;
  }
}
