// SPDX-License-Identifier: BSD-3-Clause
// The page of a running isobard.
import { Actions } from './actions';
import { element, set_text } from './dom';
import { about, count, fixed } from './format';
import { make_layout, type Layout } from './layout';
import type { MapPiece } from './map_chunks';
import { PoseHistory } from './pose_history';
import type { Link, Listener, LivePose } from './source';
import type { Floor, Setting, Status, ViewData } from './view_data';

const kSpans: [string, number][] = [['1 min', 60], ['10 min', 600], ['all', 0]];
/** Where a robot is that is on no floor, in short. */
const kPlaces: Record<string, string> = { 'on a half level': 'half level', 'between floors': 'between' };
/** Charts and path are drawn anew this often; the robot moves with every pose [ms]. */
const kRedrawMs = 500;
/** Poses come ten times a second: after this time without one, the last is old [ms]. */
const kOldMs = 2000;

export class LivePage implements Listener {
  private layout!: Layout;
  private readonly history = new PoseHistory();
  private readonly span = element('select', '');
  private actions: Actions | null = null;
  private session = 0;
  private pose_ms = 0;
  private is_new = false;
  private link: Link = { ok: true, text: '' };

  on_view(view: ViewData): void {
    this.layout = make_layout(view);
    this.history.replace(view.poses);
    this.is_new = true;
    for (const [text, span_s] of kSpans) {
      const option = element('option', '', text);
      option.value = String(span_s);
      this.span.append(option);
    }
    this.span.value = '600';
    this.span.setAttribute('aria-label', 'Time shown');
    this.span.addEventListener('change', () => {
      this.layout.height.reset_zoom();
      this.is_new = true;
      this.redraw();
    });
    this.layout.height_head.append(this.span);
    if (view.can_act) {
      this.actions = new Actions();
      this.layout.side.append(this.actions.root);
    }
    this.layout.slicer.set_floors(view.floors);
    this.layout.settings.set(view.settings);
    this.layout.summary.set('stale', 'Waiting for isobard');
    this.layout.rates.set([]);
    setInterval(() => this.redraw(), kRedrawMs);
    this.redraw();
  }

  on_map(piece: MapPiece): void {
    this.layout.map?.apply(piece);
    set_text(this.layout.map_foot, `${count(this.layout.map?.point_count ?? 0)} points`);
  }

  on_pose(pose: LivePose): void {
    if (pose.session !== this.session && this.session !== 0) this.history.replace({ ...this.empty() });
    this.session = pose.session;
    this.pose_ms = performance.now();
    this.history.add(pose);
    this.is_new = true;
    this.layout.pose.set(pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg, pose.z_sd_m);
    this.layout.pose.set_mode(pose.mode, pose.lost);
    this.layout.map?.set_robot(pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg);
  }

  on_status(status: Status): void {
    if (!this.link.ok) return;
    this.layout.summary.set(status.level, `${status.summary}`);
    this.layout.summary.root.title = `running for ${about(status.uptime_s)}`;
    this.layout.health.set(status.health);
    this.layout.rates.set(status.sensors);
    const { floor } = status;
    const number = floor && (floor.name || fixed(floor.number, 0));
    this.layout.pose.set_floor(!floor ? '' : floor.known ? String(number) : kPlaces[floor.place] ?? '');
  }

  on_floors(floors: Floor[], current: number | null): void {
    this.layout.slicer.set_floors(floors, current);
  }

  on_settings(settings: Setting[]): void {
    this.layout.settings.set(settings);
  }

  on_link(link: Link): void {
    this.link = link;
    this.layout.banner.hidden = link.ok;
    set_text(this.layout.banner, link.text);
    document.body.classList.toggle('cut-off', !link.ok);
    if (!link.ok) this.layout.summary.set('error', link.text);
  }

  on_action(text: string, failed: boolean): void {
    this.actions?.tell_outcome(text, failed);
  }

  private empty(): ViewData['poses'] {
    return Object.fromEntries(Object.keys(this.history.poses).map((key) => [key, []])) as unknown as ViewData['poses'];
  }

  private redraw(): void {
    if (this.pose_ms > 0 && performance.now() - this.pose_ms > kOldMs) this.layout.pose.set_old();
    if (!this.is_new || document.hidden) return;
    this.is_new = false;
    this.layout.height.set_poses(this.history.poses, Number(this.span.value));
    this.layout.map?.set_path(this.history.poses);
  }
}
