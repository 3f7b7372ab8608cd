// SPDX-License-Identifier: BSD-3-Clause
// While a hand moves the view, only so many points are drawn as this machine can draw 30 times a second; at rest, all.

const kSlowMs = 40;
const kFastMs = 24;
const kLeastShare = 0.01;
/** The view rests when nothing has moved it for so long. */
const kRestMs = 300;

export class FrameBudget {
  /** Called when the view has come to rest after thinned frames: draw once more. */
  on_rest: () => void = () => {};
  private held = false;
  private moved_ms = -kRestMs;
  /** Time of the last frame of this movement; 0: none yet. */
  private last_ms = 0;
  private moving_share = 1;
  private timer = 0;

  /** A hand takes or leaves the view. */
  set_held(held: boolean): void {
    this.held = held;
    this.moved();
  }

  /** The view has moved. */
  moved(): void {
    this.moved_ms = performance.now();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.rest(), kRestMs);
  }

  /** Share of the points to draw in the frame that begins now. */
  share(now_ms: number): number {
    if (!this.held && now_ms - this.moved_ms > kRestMs) {
      this.last_ms = 0;
      return 1;
    }
    const since_ms = now_ms - this.last_ms;
    if (this.last_ms > 0) {
      if (since_ms > kSlowMs) this.moving_share = Math.max(kLeastShare, this.moving_share * (since_ms > 4 * kSlowMs ? 0.3 : 0.7));
      else if (since_ms < kFastMs) this.moving_share = Math.min(1, this.moving_share * 1.1);
    }
    this.last_ms = now_ms;
    return this.moving_share;
  }

  private rest(): void {
    if (this.held) return;
    this.last_ms = 0;
    if (this.moving_share < 1) this.on_rest();
  }
}
