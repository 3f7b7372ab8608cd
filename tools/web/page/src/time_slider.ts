// SPDX-License-Identifier: BSD-3-Clause
// Moves through the time of a run: slider, play and pause, speed. Calls back with the time that is shown.
import { button, element, set_text } from './dom';
import { span } from './format';

const kSpeeds = [1, 4, 16, 64];
const kSteps = 2000;

export class TimeSlider {
  readonly root = element('div', 'time-slider');
  on_time: (t_s: number) => void = () => {};
  private readonly slider = element('input', 'time');
  private readonly text = element('output', 'time-text');
  private readonly play_button = button('Play', 'chip', () => this.toggle());
  private readonly speed_button = button('4×', 'chip', () => this.next_speed());
  private first_s = 0;
  private last_s = 1;
  private t_s = 0;
  private speed = 4;
  private playing = false;

  constructor() {
    this.slider.type = 'range';
    this.slider.min = '0';
    this.slider.max = String(kSteps);
    this.slider.setAttribute('aria-label', 'Time of the run');
    this.slider.addEventListener('input', () => {
      this.playing = false;
      this.show_button();
      this.go_to(this.first_s + (Number(this.slider.value) / kSteps) * (this.last_s - this.first_s));
    });
    this.speed_button.title = 'Speed';
    this.root.append(this.play_button, this.speed_button, this.slider, this.text);
  }

  set_range(first_s: number, last_s: number): void {
    this.first_s = first_s;
    this.last_s = Math.max(last_s, first_s + 0.1);
    this.go_to(this.last_s);
  }

  go_to(t_s: number): void {
    this.t_s = Math.min(this.last_s, Math.max(this.first_s, t_s));
    this.slider.value = String(Math.round((kSteps * (this.t_s - this.first_s)) / (this.last_s - this.first_s)));
    set_text(this.text, `${span(this.t_s, 1)} / ${span(this.last_s)}`);
    this.slider.setAttribute('aria-valuetext', span(this.t_s, 1));
    this.on_time(this.t_s);
  }

  private toggle(): void {
    this.playing = !this.playing;
    if (this.playing && this.t_s >= this.last_s) this.go_to(this.first_s);
    this.show_button();
    if (this.playing) this.step(performance.now());
  }

  private step(before_ms: number): void {
    requestAnimationFrame((now_ms) => {
      if (!this.playing) return;
      this.go_to(this.t_s + (this.speed * Math.max(0, now_ms - before_ms)) / 1000);
      if (this.t_s >= this.last_s) this.playing = false;
      this.show_button();
      if (this.playing) this.step(now_ms);
    });
  }

  private next_speed(): void {
    this.speed = kSpeeds[(kSpeeds.indexOf(this.speed) + 1) % kSpeeds.length];
    set_text(this.speed_button, `${this.speed}×`);
  }

  private show_button(): void {
    set_text(this.play_button, this.playing ? 'Pause' : 'Play');
  }
}
