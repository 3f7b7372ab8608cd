// SPDX-License-Identifier: BSD-3-Clause
// A running isobard, through `isobar web`: one stream of events, and the map fetched when an event says that it has
// changed. Goes on by itself after a restart of either program.
import { MapFetcher } from './run_source';
import type { Link, Listener, LivePose, Source } from './source';
import type { Floor, MapState, Setting, Status, ViewData } from './view_data';

/** The server sends something every second; without it the link is lost [ms]. */
const kSilenceMs = 5000;
const kRetryMs = 1000;

export class LiveSource implements Source {
  private events: EventSource | null = null;
  private heard_ms = 0;
  private lost = false;
  private map: MapFetcher | null = null;

  constructor(private readonly view: ViewData) {}

  start(listener: Listener): void {
    listener.on_view(this.view);
    this.map = new MapFetcher(listener);
    this.connect(listener);
    setInterval(() => this.watch(listener), 500);
  }

  private connect(listener: Listener): void {
    this.events?.close();
    this.heard_ms = performance.now();
    const events = new EventSource('/api/events');
    this.events = events;
    const on = <Payload>(name: string, take: (payload: Payload) => void) =>
      events.addEventListener(name, (event) => {
        this.heard(listener);
        take(JSON.parse((event as MessageEvent<string>).data) as Payload);
      });
    on<Link>('link', (link) => listener.on_link?.(link));
    const origin_s = Number(this.view.origin_ns) / 1e9;
    on<LivePose & { stamp_s: number }>('pose', (pose) => listener.on_pose?.({ ...pose, t_s: pose.stamp_s - origin_s }));
    on<Status>('status', (status) => listener.on_status?.(status));
    on<{ floors: Floor[]; current: number | null }>('floors', ({ floors, current }) => listener.on_floors?.(floors, current));
    on<MapState>('map', () => this.fetch_map(listener));
    on<Setting[]>('settings', (settings) => listener.on_settings?.(settings));
    on<{ text: string; failed: boolean }>('action', ({ text, failed }) => listener.on_action?.(text, failed));
    on<object>('alive', () => {});
  }

  private fetch_map(listener: Listener): void {
    // A map that fails to come is fetched with the next event.
    void this.map?.update().catch(() => listener);
  }

  private heard(listener: Listener): void {
    this.heard_ms = performance.now();
    if (!this.lost) return;
    this.lost = false;
    // The server may be another one: its history begins anew, what is drawn stays.
    this.fetch_map(listener);
  }

  private watch(listener: Listener): void {
    const silent_ms = performance.now() - this.heard_ms;
    const is_closed = this.events?.readyState === EventSource.CLOSED;
    if (silent_ms < kSilenceMs && !is_closed) return;
    if (!this.lost) listener.on_link?.({ ok: false, text: 'No connection to isobar web on the robot. Trying again every second.' });
    this.lost = true;
    if (is_closed ? silent_ms > kRetryMs : silent_ms > kSilenceMs + kRetryMs) this.connect(listener);
  }
}
