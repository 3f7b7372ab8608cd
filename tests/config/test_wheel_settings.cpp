// SPDX-License-Identifier: BSD-3-Clause
// [wheel] and [wheel.encoder].
#include <doctest/doctest.h>

#include <string>

#include "config/config_io.hpp"
#include "core/errors.hpp"

namespace isobar::test::test_wheel_settings {

namespace {

void is_refused(const std::string& text, const std::string& words) {
  CAPTURE(text);
  CHECK_THROWS_WITH_AS(parse_config(text, "c.toml"), doctest::Contains(words.c_str()), ConfigError);
}

}  // namespace

TEST_CASE("Encoders need two lines a side, none of them twice") {
  const std::string lines =
      "[wheel]\nsource = \"encoder\"\n[wheel.encoder]\nleft_a = 17\nleft_b = 18\nright_a = 22\n";
  const Config config = parse_config(
      lines + "right_b = 23\nright_reversed = true\ndrive = \"skid-steer\"\ntrack_factor = 1.7\n", "c.toml");
  CHECK(config.wheel.source == WheelSource::kEncoder);
  CHECK(config.wheel.present());
  CHECK(config.wheel.encoder.geometry.drive == encoder::Drive::kSkidSteer);
  CHECK(config.wheel.encoder.geometry.track_factor == 1.7);
  CHECK(config.wheel.encoder.encoders()[0].a == 17);
  CHECK(config.wheel.encoder.encoders()[1].a == 23);  // exchanged: reversed
  CHECK(config.wheel.encoder.encoders()[1].b == 22);
  CHECK_FALSE(config.wheel.encoder.encoders()[2].present());
  is_refused(lines, "wheel.encoder.right_b: must name a line: each side needs an encoder with two lines");
  is_refused(lines + "right_b = -1\n", "c.toml:7:11: wheel.encoder.right_b: must name a line");
  is_refused(lines + "right_b = 17\n",
             "c.toml:7:11: wheel.encoder.right_b: must differ from every other line");
  is_refused(lines + "right_b = 23\nrear_left_b = 5\n",
             "wheel.encoder.rear_left_a: must name a line: an encoder has two");
  is_refused(lines + "right_b = 23\nrear_right_a = 5\nrear_right_b = 5\n",
             "c.toml:9:16: wheel.encoder.rear_right_b");
  is_refused(lines + "right_b = 23\ntrack_factor = 0.7\n",
             "c.toml:8:16: wheel.encoder.track_factor: must be");
  is_refused("[wheel.encoder]\ndrive = \"mecanum\"\n", "must be one of differential, skid-steer, tracked");
  CHECK_FALSE(parse_config("[wheel.encoder]\nleft_a = 3\n", "c.toml").wheel.source == WheelSource::kEncoder);
}

}  // namespace isobar::test::test_wheel_settings
