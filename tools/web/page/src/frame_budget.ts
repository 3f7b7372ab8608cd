// SPDX-License-Identifier: BSD-3-Clause
// How many points a frame may draw, so that this machine draws 30 frames a second: found from the time that the graphics
// card, or the software in its place, takes for each. No frame begins before the last one is done, so that a hand never
// waits for frames in a queue.

const kFirstPoints = 1_000_000;
const kLeastPoints = 20_000;
const kMostPoints = 8_000_000;
/** A frame above this is too slow [ms]: with the wait for the screen, 30 frames a second are lost. */
const kSlowMs = 28;
const kWantedMs = 22;
const kQuickMs = 16;
/** How often the card is asked whether it is done, and when it is given up [ms]. */
const kPollMs = 3;
const kGiveUpMs = 1000;

export class FrameBudget {
  private allowed = kFirstPoints;
  private fence: WebGLSync | null = null;
  private began_ms = 0;
  private points_drawn = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {}

  /** Points that the next frame may draw. */
  get points(): number {
    return this.allowed;
  }

  /** The last frame is still being drawn. */
  get is_busy(): boolean {
    return this.fence !== null;
  }

  /** Call it when all commands of a frame with so many points were given, which began at began_ms. */
  drawn(points: number, began_ms: number): void {
    this.began_ms = began_ms;
    const is_polled = this.fence !== null;
    if (this.fence) this.gl.deleteSync(this.fence);
    this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
    this.points_drawn = points;
    if (!is_polled) setTimeout(() => this.poll(), kPollMs);
  }

  private poll(): void {
    if (!this.fence) return;
    const took_ms = performance.now() - this.began_ms;
    const is_done = this.gl.clientWaitSync(this.fence, 0, 0) !== this.gl.TIMEOUT_EXPIRED;
    if (!is_done && took_ms < kGiveUpMs) {
      setTimeout(() => this.poll(), kPollMs);
      return;
    }
    this.gl.deleteSync(this.fence);
    this.fence = null;
    this.learn(this.points_drawn, took_ms);
  }

  private learn(points: number, took_ms: number): void {
    // A frame of few points is slow for other reasons, as the first one, in which shaders are compiled.
    if (points < kLeastPoints) return;
    if (took_ms > kSlowMs) this.allowed = Math.max(kLeastPoints, Math.min(points, this.allowed) * Math.max(0.3, kWantedMs / took_ms));
    // A frame with far fewer points than it might have tells nothing of more.
    else if (took_ms < kQuickMs && points >= 0.5 * this.allowed) this.allowed = Math.min(kMostPoints, this.allowed * (took_ms < kQuickMs / 2 ? 2 : 1.2));
  }
}
