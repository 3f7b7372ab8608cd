// SPDX-License-Identifier: BSD-3-Clause
// What all charts have in common.
import type uPlot from 'uplot';
import { element, style_value } from './dom';

export const kAxisFont = '11px system-ui, sans-serif';
/** Charts below this width give their text less room. */
export const kNarrowPx = 560;

/** The value of a colour that may be the name of a custom property, for a canvas. */
export function colour_of(name: string): string {
  return name.startsWith('--') ? style_value(name) : name;
}

/** The same for a style sheet, which follows the theme by itself. */
export function css_colour(name: string): string {
  return name.startsWith('--') ? `var(${name})` : name;
}

/** A number as a person reads it, with a true minus sign. */
export function number_text(value: number, decimals: number): string {
  return value.toFixed(decimals).replace('-', '−');
}

/** An axis whose text and grid follow the theme. */
export function themed_axis(label?: string): uPlot.Axis {
  return {
    stroke: () => style_value('--muted'), font: kAxisFont, ticks: { show: false },
    grid: { stroke: () => style_value('--line'), width: 1 },
    ...(label === undefined ? {} : { label, labelFont: kAxisFont, labelSize: 18, labelGap: 0 }),
  };
}

/** A font in the pixels of the canvas. */
export function scaled(font: string): string {
  return font.replace(/^(\d+)px/, (_, px) => `${Number(px) * devicePixelRatio}px`);
}

export function swatch(colour: string): HTMLElement {
  const made = element('i', 'swatch');
  made.style.background = css_colour(colour);
  return made;
}

/** A box of text that stands beside the cursor of a chart, on the side that has room. */
export class Readout {
  private readonly box = element('div', 'readout');

  attach(plot: uPlot): void {
    plot.over.append(this.box);
    this.hide();
  }

  hide(): void {
    this.box.hidden = true;
  }

  show(plot: uPlot, left_px: number, ...lines: HTMLElement[]): void {
    this.box.hidden = false;
    this.box.replaceChildren(...lines);
    const is_right = left_px > plot.over.clientWidth / 2;
    this.box.style.left = is_right ? 'auto' : `${left_px + 14}px`;
    this.box.style.right = is_right ? `${plot.over.clientWidth - left_px + 14}px` : 'auto';
  }
}
