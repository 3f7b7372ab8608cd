// SPDX-License-Identifier: BSD-3-Clause
// The sensors: how many samples a second, how old the newest is, what was lost.
import { element, panel, set_text } from './dom';
import { count, fixed } from './format';
import type { Sensor } from './view_data';

const kTitles: Record<string, string> = {
  lidar: 'Lidar', lidar_packets: 'Lidar packets', imu: 'IMU', barometer: 'Barometer', base_barometer: 'Base station', wheel: 'Wheels', wheels: 'Wheels',
  base_station: 'Base station', base: 'Base station',
};

/** A sensor that should be heard, and has not been for this long, is marked [s]. */
const kSilentS = 2;
const kPlaces = 6;

export class Rates {
  readonly root: HTMLElement;
  private readonly rows = element('tbody', '');
  private names = '';

  constructor(private readonly is_live: boolean) {
    const { root, body } = panel('Sensors', 'rates');
    this.root = root;
    const heads = is_live ? ['', 'rate', 'age', 'lost', 'refused'] : ['', 'rate', 'samples', 'span'];
    const row = element('tr', '', ...heads.map((head) => element('th', '', head)));
    body.append(element('table', 'figures', element('thead', '', row), this.rows));
  }

  set(sensors: Sensor[]): void {
    const names = sensors.map((sensor) => sensor.name).join();
    if (names !== this.names || this.rows.childElementCount === 0) this.make(sensors);
    this.names = names;
    sensors.forEach((sensor, i) => this.fill(this.rows.children[i] as HTMLElement, sensor));
  }

  private make(sensors: Sensor[]): void {
    this.rows.replaceChildren(...sensors.map((sensor) => {
      const name = element('th', '', kTitles[sensor.name] ?? sensor.name, sensor.file ? element('span', 'message', sensor.file) : null);
      name.scope = 'row';
      return element('tr', '', name, ...Array.from({ length: this.is_live ? 4 : 3 }, () => element('td', '')));
    }));
    // Places for the sensors that come, so that nothing moves then.
    for (let i = sensors.length; this.is_live && i < kPlaces; ++i) {
      this.rows.append(element('tr', '', element('th', '', '\u00a0'), ...Array.from({ length: 4 }, () => element('td', ''))));
    }
  }

  private fill(row: HTMLElement, sensor: Sensor): void {
    const rate = sensor.heard ? `${fixed(sensor.rate_hz, (sensor.rate_hz ?? 0) < 100 ? 1 : 0)} Hz` : 'none';
    const age_s = sensor.age_s ?? 0;
    const texts = this.is_live
      ? [rate, sensor.heard ? (age_s < 1 ? `${fixed(1000 * age_s, 0)} ms` : `${fixed(age_s, 1)} s`) : '–', count(sensor.lost),
          count((sensor.rejected ?? 0) + (sensor.dropped ?? 0))]
      : [rate, count(sensor.samples), `${fixed(sensor.age_s, 1)} s`];
    texts.forEach((text, i) => set_text(row.children[i + 1], text));
    row.classList.toggle('silent', this.is_live && (!sensor.heard || age_s > kSilentS));
  }
}
