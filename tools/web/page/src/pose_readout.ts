// SPDX-License-Identifier: BSD-3-Clause
// The pose in figures.
import { element, set_text } from './dom';
import { fixed } from './format';

const kFields = [['x', 'm'], ['y', 'm'], ['z', 'm'], ['yaw', '°'], ['σ z', 'm'], ['floor', ''], ['pose', '']] as const;
type Field = (typeof kFields)[number][0];

/** Where fields have another label than their name, and what explains it. */
const kLabels: Partial<Record<Field, [string, string]>> = {
  'σ z': ['± z', 'standard deviation of z'],
  pose: ['pose from', 'lidar: a scan was matched to the map; motion: between scans, from inertial sensors and wheels'],
};
const kModes: Record<string, string> = {
  registered: 'lidar', prior: 'motion', initializing: 'starting',
};

export class PoseReadout {
  readonly root = element('dl', 'pose');
  private readonly values = new Map<Field, HTMLElement>();

  constructor() {
    for (const [name, unit] of kFields) {
      const value = element('dd', '', '–');
      this.values.set(name, value);
      const [label, meaning] = kLabels[name] ?? [name, ''];
      const field = element('div', `pose-${name.replace(' ', '-')}`, element('dt', '', unit ? `${label} ${unit}` : label), value);
      field.title = meaning;
      this.root.append(field);
    }
    this.root.setAttribute('aria-label', 'Pose of the robot in the map');
  }

  set(x_m: number | null, y_m: number | null, z_m: number | null, yaw_deg: number | null, z_sd_m: number | null): void {
    this.put('x', fixed(x_m, 2));
    this.put('y', fixed(y_m, 2));
    this.put('z', fixed(z_m, 3));
    this.put('yaw', fixed(yaw_deg, 1));
    this.put('σ z', fixed(z_sd_m, 3));
  }

  set_floor(text: string): void {
    this.put('floor', text || '–');
  }

  /** No pose has come for a while: what is shown is old. */
  set_old(): void {
    this.put('pose', 'no pose');
    this.root.classList.add('old');
  }

  set_mode(mode: string, lost = ''): void {
    this.root.classList.remove('old');
    this.put('pose', lost ? 'lost' : (kModes[mode] ?? mode) || '–');
    this.root.classList.toggle('lost', lost !== '');
  }

  private put(field: Field, text: string): void {
    set_text(this.values.get(field)!, text);
  }
}
