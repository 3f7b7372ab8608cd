// SPDX-License-Identifier: BSD-3-Clause
// The poses of a live view: bounded, however long the page stays open. When full, every other one goes, so that the
// whole time stays covered, ever more coarsely, and the newest part stays as it came.
import type { LivePose } from './source';
import { empty_poses, type Column, type Poses } from './view_data';

const kMost = 24_000;
/** The newest poses that are never thinned: five minutes at 10 Hz. */
const kKept = 3000;
const kGapS = 2;
const kClockStepS = 5;

export class PoseHistory {
  poses: Poses = empty_poses();

  replace(poses: Poses): void {
    this.poses = poses;
  }

  add(pose: LivePose): void {
    const last_s = this.poses.t_s[this.poses.t_s.length - 1];
    if (last_s !== undefined && pose.t_s <= last_s) {
      if (pose.t_s > last_s - kClockStepS) return;
      this.poses = empty_poses(); // another isobard, on another clock
    } else if (last_s !== undefined && pose.t_s > last_s + kGapS) {
      this.push_gap(last_s);
    }
    for (const key of Object.keys(this.poses) as (keyof Poses)[]) (this.poses[key] as Column).push(pose[key]);
    if (this.poses.t_s.length > kMost) this.thin();
  }

  /** A row without values, so that no line is drawn across the time without poses. */
  private push_gap(last_s: number): void {
    for (const key of Object.keys(this.poses) as (keyof Poses)[]) {
      (this.poses[key] as Column).push(key === 't_s' ? last_s + 0.01 : null);
    }
  }

  private thin(): void {
    const cut = this.poses.t_s.length - kKept;
    for (const key of Object.keys(this.poses) as (keyof Poses)[]) {
      (this.poses[key] as Column) = (this.poses[key] as Column).filter((_, i) => i >= cut || i % 2 === 0);
    }
  }
}
