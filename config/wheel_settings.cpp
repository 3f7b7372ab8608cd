// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {
namespace {

constexpr int kLastLine = 511;

void add_lines(encoder::Settings& encoder, SectionBuilder& s) {
  s.text("chip", encoder.chip, TextRule::kAny,
         "GPIO chip with all lines of the encoders. isobard needs the right to open it.");
  s.number("left_a", &encoder.left.a, "", -1, kLastLine,
           "Line of the chip with track A of the left encoder, or of the front left one. -1: not wired.");
  s.number("left_b", &encoder.left.b, "", -1, kLastLine,
           "The same of its track B. Forward, A leads B; else left_reversed.");
  s.number("right_a", &encoder.right.a, "", -1, kLastLine,
           "Track A of the right encoder, or of the front right one. -1: not wired.");
  s.number("right_b", &encoder.right.b, "", -1, kLastLine,
           "The same of its track B. Forward, A leads B; else right_reversed.");
  s.number("rear_left_a", &encoder.rear_left.a, "", -1, kLastLine,
           "Track A of a second encoder on the left. -1: there is none. A side's speed is the mean of its "
           "encoders.");
  s.number("rear_left_b", &encoder.rear_left.b, "", -1, kLastLine,
           "Track B of a second encoder on the left.");
  s.number("rear_right_a", &encoder.rear_right.a, "", -1, kLastLine,
           "Track A of a second encoder on the right. -1: there is none.");
  s.number("rear_right_b", &encoder.rear_right.b, "", -1, kLastLine,
           "Track B of a second encoder on the right.");
  s.flag("left_reversed", encoder.left_reversed,
         "Whether the encoders of the left side count backwards when the robot goes forward.");
  s.flag("right_reversed", encoder.right_reversed,
         "The same of the right side. Motors that are mounted as mirror images count against each other.");
}

void add_encoder(encoder::Settings& encoder, std::vector<Setting>& settings) {
  SectionBuilder s("wheel.encoder", UsedBy::kRobot, settings);
  add_lines(encoder, s);
  encoder::Geometry& geometry = encoder.geometry;
  s.number(
      "counts_per_turn", &geometry.counts_per_turn, "", 1.0, 1e7,
      "Counts in a turn of the wheel: four times the periods of the encoder in a turn of its shaft, times "
      "the gear ratio between shaft and wheel.");
  s.number(
      "wheel_radius_m", &geometry.wheel_radius_m, "m", 0.005, 2.0,
      "Radius of a wheel under load, or pitch radius of a track's sprocket. `isobar calibrate mounts` finds "
      "the scale of the distance that is left.");
  s.number("track_width_m", &geometry.track_width_m, "m", 0.02, 10.0,
           "Distance between the middles of the left and the right wheels, or tracks.");
  s.choice("drive", &geometry.drive, encoder::kDriveNames.names(),
           "How a difference of the sides turns the robot. differential: two driven wheels and casters. "
           "skid-steer, tracked: wheels or tracks that are dragged sideways in a turn.");
  s.number("track_factor", &geometry.track_factor, "", 1.0, 5.0,
           "Effective over real track width of a skid-steer or tracked drive; without a meaning for a "
           "differential one. 1.3 to 2 on hard floors; `isobar calibrate mounts` finds what is left.");
  s.number(
      "rate_hz", &encoder.rate_hz, "Hz", 10, 200,
      "Samples per second, each the mean speed of its period. 50: five in a scan at 10 Hz, and a count more "
      "or less is a small part of a sample.");
}

}  // namespace

void add_wheel_settings(WheelSettings& wheel, std::vector<Setting>& settings) {
  SectionBuilder s("wheel", UsedBy::kRobot, settings);
  s.choice(
       "source", &wheel.source, kWheelSourceNames.names(),
       "Source of the wheels' odometry; samples of any other source are refused. datagram: sample "
       "datagrams by UDP; a robot that sends none has none. dds: the ROS 2 topic dds.topics.wheel, "
       "through isobar-dds. none: not used. encoder: encoders on GPIO lines of this machine, which isobard "
       "reads itself, set up in the section of that name.")
      .basic();
  add_encoder(wheel.encoder, settings);
}

}  // namespace isobar
