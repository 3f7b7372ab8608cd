// SPDX-License-Identifier: BSD-3-Clause
// A page that holds its own data, such as a report: <script type="application/json" id="isobar-view"> with a ViewData,
// and, where there is a map, <script type="text/plain" id="isobar-map"> with the bytes of /api/map in base64.
import { decode_map } from './map_chunks';
import type { Listener, Source } from './source';
import type { ViewData } from './view_data';

function text_of(id: string): string | null {
  return document.getElementById(id)?.textContent ?? null;
}

/** True where the page has data of its own. */
export function has_inline_view(): boolean {
  return text_of('isobar-view') !== null;
}

export class InlineSource implements Source {
  start(listener: Listener): void {
    // Both before the page is laid out, which replaces what stands in it.
    const view = JSON.parse(text_of('isobar-view') ?? '') as ViewData;
    const map = text_of('isobar-map');
    listener.on_view(view);
    if (map) listener.on_map(decode_map(Uint8Array.from(atob(map.trim()), (byte) => byte.charCodeAt(0)).buffer));
  }
}
