// SPDX-License-Identifier: BSD-3-Clause
// Health as lights: one for the whole in the head of the page, and one a subject with the sentence that explains it,
// the worst first. A level is told by colour, by shape and by a word.
import { button, element, panel, set_text } from './dom';
import type { HealthEntry, Level } from './view_data';

const kSeverity: Record<Level, number> = { ok: 0, warning: 1, stale: 2, error: 3 };
const kWords: Record<Level, string> = { ok: 'ok', warning: 'warning', stale: 'no data', error: 'error' };

/** The summary begins with the name of what it is about. */
function readable(sentence: string): string {
  return sentence.replace(/^[a-z_]+(\/[a-z_]+)?(?=: )/, subject);
}

/** "lidar/packets_lost" is read "lidar: packets lost". */
function subject(name: string): string {
  return name.replaceAll('_', ' ').replace('/', ': ');
}

export function light(level: Level): HTMLElement {
  const made = element('span', `light ${level}`);
  made.setAttribute('role', 'img');
  made.setAttribute('aria-label', kWords[level]);
  return made;
}

/** The light of the whole, with its sentence. */
export class SummaryLight {
  readonly root = element('div', 'summary stale');
  private readonly word = element('strong', '');
  private readonly sentence = element('span', 'summary-text');

  constructor() {
    this.root.setAttribute('role', 'status');
    this.root.append(element('span', 'light'), this.word, this.sentence);
  }

  set(level: Level, sentence: string): void {
    this.root.className = `summary ${level}`;
    this.root.firstElementChild!.className = `light ${level}`;
    set_text(this.word, kWords[level]);
    set_text(this.sentence, readable(sentence));
    this.sentence.title = sentence;
  }
}

export class HealthLights {
  readonly root: HTMLElement;
  private readonly list = element('ul', 'lights');
  private readonly toggle: HTMLButtonElement;
  private all = false;
  private entries: HealthEntry[] = [];
  private shown = '';

  constructor() {
    const { root, head, body } = panel('Health', 'health');
    this.root = root;
    this.toggle = button('Show all', 'quiet', () => {
      this.all = !this.all;
      this.show();
    });
    head.append(this.toggle);
    this.list.tabIndex = 0;  // it scrolls
    this.list.setAttribute('aria-label', 'Health');
    body.append(this.list);
    this.show();
  }

  set(entries: HealthEntry[]): void {
    this.entries = entries;
    this.show();
  }

  private show(): void {
    const listed = this.entries.filter((entry) => entry.name !== 'summary');
    const bad = listed.filter((entry) => entry.level !== 'ok').sort((a, b) => kSeverity[b.level] - kSeverity[a.level]);
    const good = listed.filter((entry) => entry.level === 'ok');
    // Counters that are well say little: the subjects themselves stand for them.
    const subjects = good.filter((entry) => !entry.name.includes('/'));
    const rows = [...bad, ...(this.all ? good : subjects)];
    set_text(this.toggle, this.all ? 'Show less' : `Show all ${listed.length}`);
    this.toggle.hidden = listed.length === rows.length && !this.all;
    const key = JSON.stringify(rows.map(({ name, level, message }) => [name, level, message]));
    if (key === this.shown) return;
    this.shown = key;
    this.list.replaceChildren(...rows.map((entry) => element('li', entry.level, light(entry.level),
      element('span', 'subject', subject(entry.name)), element('span', 'sentence', entry.message || kWords[entry.level]))));
    if (rows.length === 0) this.list.append(element('li', 'nothing', 'Nothing is told.'));
  }
}
