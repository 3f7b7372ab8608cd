// SPDX-License-Identifier: BSD-3-Clause
// Elements of the page, made without HTML in strings: a text from outside is only ever a text.

type Child = Node | string | null | undefined;

/** An element with a class and children; `tag` may carry classes, "div.panel.wide". */
export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag, classes = '', ...children: Child[]): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  if (classes) made.className = classes;
  for (const child of children) if (child !== null && child !== undefined) made.append(child);
  return made;
}

/** Sets a text only where it differs, so that an unchanged one costs no layout. */
export function set_text(target: Node, text: string): void {
  if (target.textContent !== text) target.textContent = text;
}

/** A button with a label. */
export function button(label: string, classes: string, on_click: () => void): HTMLButtonElement {
  const made = element('button', classes, label);
  made.type = 'button';
  made.addEventListener('click', on_click);
  return made;
}

/** A panel with a heading; `body` is what fills it. */
export function panel(title: string, classes = ''): { root: HTMLElement; head: HTMLElement; body: HTMLElement } {
  const head = element('header', 'panel-head', element('h2', '', title));
  const body = element('div', 'panel-body');
  return { root: element('section', `panel ${classes}`, head, body), head, body };
}

/** Makes a part that scrolls reachable by the keyboard. */
export function scrolls<Part extends HTMLElement>(part: Part, label: string): Part {
  part.tabIndex = 0;
  part.setAttribute('role', 'region');
  part.setAttribute('aria-label', label);
  return part;
}

/** The value of a custom property of the style sheet, such as "--ink". */
export function style_value(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Calls back when the reader changes between light and dark. */
export function on_theme_change(callback: () => void): void {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', callback);
}
