// SPDX-License-Identifier: BSD-3-Clause
// Which heights of the map are shown: a legend in metres with two handles, and a button for each floor.
import { button, element, on_theme_change, set_text } from './dom';
import { height_gradient } from './colour_map';
import { fixed } from './format';
import type { Floor } from './view_data';

/** A floor shows from a little below its ground to above a person, below the next ceiling. */
const kBelowFloorM = 0.4;
const kAboveFloorM = 2.1;
const kSteps = 200;

export class FloorSlicer {
  readonly root = element('div', 'slicer');
  /** null: all heights. */
  on_slice: (slice_m: [number, number] | null) => void = () => {};
  /** Grounds of the floors whose ceilings are left out. */
  on_cut: (floors_m: number[]) => void = () => {};
  private readonly buttons = element('div', 'floor-buttons');
  private readonly bar = element('div', 'slice-bar');
  private readonly low = this.handle('lowest height shown');
  private readonly high = this.handle('highest height shown');
  private readonly low_text = element('output', 'slice-text');
  private readonly high_text = element('output', 'slice-text');
  private range_m: [number, number] = [0, 3];
  private slice_m: [number, number] | null = null;
  private floors: Floor[] = [];
  private chosen: number | null = null;
  private has_ceilings = false;
  private readonly ceilings = button('Ceilings', 'chip', () => {
    this.has_ceilings = !this.has_ceilings;
    this.mark();
    this.tell();
  });

  constructor() {
    this.ceilings.title = 'Show also what lies more than 1.9 m above the floors';
    this.low.value = '0';
    this.high.value = String(kSteps);
    this.buttons.setAttribute('role', 'group');
    this.buttons.setAttribute('aria-label', 'Floors');
    this.root.append(this.buttons, element('div', 'slice', this.low_text, element('div', 'slice-track', this.bar, this.low, this.high), this.high_text));
    const paint = () => this.bar.style.setProperty('background', height_gradient(matchMedia('(prefers-color-scheme: dark)').matches, 'to right'));
    paint();
    on_theme_change(paint);
    this.show();
  }

  set_range(range_m: [number, number]): void {
    this.range_m = range_m;
    this.show();
  }

  /** @param current number of the floor that the robot is on, marked on its button */
  set_floors(floors: Floor[], current: number | null = null): void {
    const ordered = [...floors].sort((a, b) => a.z_m - b.z_m);
    const is_same = JSON.stringify(ordered) === JSON.stringify(this.floors) && this.buttons.childElementCount > 0;
    this.floors = ordered;
    if (!is_same) {
      this.make_buttons();
      this.tell();
    }
    for (const child of this.buttons.children) child.classList.toggle('here', (child as HTMLElement).dataset.floor === String(current));
  }

  private handle(label: string): HTMLInputElement {
    const input = element('input', 'slice-handle');
    input.type = 'range';
    input.min = '0';
    input.max = String(kSteps);
    input.setAttribute('aria-label', label);
    input.addEventListener('input', () => this.take_handles());
    return input;
  }

  private make_buttons(): void {
    const all = button('All', 'chip', () => this.choose(null));
    const rest = this.floors.map((floor) => {
      const made = button(floor.name || `Floor ${fixed(floor.number, 0)}`, 'chip', () => this.choose(floor));
      made.title = `ground at ${fixed(floor.z_m, 2)} m`;
      made.dataset.floor = String(floor.number);
      return made;
    });
    this.buttons.replaceChildren(...(rest.length ? [all, ...rest, this.ceilings] : []));
    this.mark();
  }

  private choose(floor: Floor | null): void {
    this.chosen = floor ? floor.number : null;
    this.slice_m = floor ? [floor.z_m - kBelowFloorM, this.top_of(floor)] : null;
    this.show();
    this.tell();
  }

  private top_of(floor: Floor): number {
    const above = this.floors.find((other) => other.z_m > floor.z_m + 0.5);
    return Math.min(floor.z_m + kAboveFloorM, above ? above.z_m - kBelowFloorM : Infinity);
  }

  private take_handles(): void {
    const [low, high] = [Number(this.low.value), Number(this.high.value)].sort((a, b) => a - b);
    this.chosen = null;
    this.slice_m = low === 0 && high === kSteps ? null : [this.height_at(low), this.height_at(high)];
    this.show();
    this.tell();
  }

  private height_at(step: number): number {
    return this.range_m[0] + (step / kSteps) * (this.range_m[1] - this.range_m[0]);
  }

  /** Calls back with what is chosen. */
  tell(): void {
    this.on_slice(this.slice_m);
    const is_cut = this.slice_m === null && !this.has_ceilings;
    this.on_cut(is_cut ? this.floors.map((floor) => floor.z_m) : []);
  }

  private show(): void {
    const [low, high] = this.slice_m ?? this.range_m;
    const share = (value: number) => Math.min(1, Math.max(0, (value - this.range_m[0]) / Math.max(0.01, this.range_m[1] - this.range_m[0])));
    this.low.value = String(Math.round(share(low) * kSteps));
    this.high.value = String(Math.round(share(high) * kSteps));
    // All colours between the handles, as the map is drawn.
    this.bar.style.setProperty('left', `${100 * share(low)}%`);
    this.bar.style.setProperty('right', `${100 * (1 - share(high))}%`);
    set_text(this.low_text, `${fixed(low, 1)} m`);
    set_text(this.high_text, `${fixed(high, 1)} m`);
    this.mark();
  }

  private mark(): void {
    this.ceilings.setAttribute('aria-pressed', String(this.has_ceilings && this.slice_m === null));
    this.ceilings.disabled = this.slice_m !== null;
    for (const child of this.buttons.children) {
      if (child === this.ceilings) continue;
      const floor = (child as HTMLElement).dataset.floor;
      const is_chosen = floor === undefined ? this.slice_m === null : floor === String(this.chosen);
      child.setAttribute('aria-pressed', String(is_chosen));
    }
  }
}
