// SPDX-License-Identifier: BSD-3-Clause
// A finished run or a recording, read by `isobar web`.
import { decode_map } from './map_chunks';
import type { Listener, Source } from './source';
import type { ViewData } from './view_data';

/** Fetches what the server holds, with the reason in words where it refuses. */
export async function fetch_ok(path: string): Promise<Response> {
  const answer = await fetch(path, { cache: 'no-store' });
  if (!answer.ok) throw new Error(`${path}: ${answer.status} ${await answer.text()}`);
  return answer;
}

/** Brings a map up to date, piece by piece; ends where the server has nothing newer. */
export class MapFetcher {
  private epoch = 0;
  private change = 0;
  private busy = false;
  private again = false;

  constructor(private readonly listener: Listener) {}

  async update(): Promise<void> {
    this.again = true;
    if (this.busy) return;
    this.busy = true;
    try {
      while (this.again) {
        this.again = false;
        await this.fetch_all();
      }
    } finally {
      this.busy = false;
    }
  }

  private async fetch_all(): Promise<void> {
    for (let more = true; more;) {
      const answer = await fetch_ok(`/api/map?epoch=${this.epoch}&since=${this.change}`);
      const piece = decode_map(await answer.arrayBuffer());
      this.epoch = piece.epoch;
      this.change = piece.change;
      more = piece.more;
      this.listener.on_map(piece);
    }
  }
}

export class RunSource implements Source {
  constructor(private readonly view: ViewData) {}

  start(listener: Listener): void {
    listener.on_view(this.view);
    if (this.view.map.points === 0) return;
    void new MapFetcher(listener).update().catch((error: Error) => listener.on_link?.({ ok: false, text: error.message }));
  }
}
