// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <vector>

#include "core/merge/frame_vote.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_frame_vote {
namespace {

Eigen::Isometry3d frame(double x_m, double yaw_rad = 0.0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_about_z(yaw_rad);
  T.translation().x() = x_m;
  return T;
}

PlaceVote vote(double x_b_m, std::vector<FrameHypothesis> hypotheses) {
  return {{x_b_m, 0.0, 0.0}, std::move(hypotheses)};
}

TEST_CASE("three different places that agree tell the frame, two do not") {
  std::vector<PlaceVote> votes{vote(0.0, {{frame(5.0), 1.0}}), vote(10.0, {{frame(5.1), 1.0}})};
  CHECK_FALSE(common_frame(votes).T_a_b.has_value());
  votes.push_back(vote(20.0, {}));
  CHECK_FALSE(common_frame(votes).T_a_b.has_value());
  votes.push_back(vote(30.0, {{frame(4.9), 1.0}}));
  const FrameVerdict verdict = common_frame(votes);
  REQUIRE(verdict.T_a_b.has_value());
  CHECK(verdict.T_a_b->translation().x() == doctest::Approx(5.0).epsilon(0.03));
  CHECK(verdict.located == 3);
  CHECK(verdict.agreeing.size() == 3);
}

TEST_CASE("searches of one place count once") {
  const std::vector<PlaceVote> votes{vote(0.0, {{frame(5.0), 1.0}}), vote(1.0, {{frame(5.0), 1.0}}),
                                     vote(2.0, {{frame(5.0), 1.0}}), vote(20.0, {{frame(5.0), 1.0}})};
  CHECK_FALSE(common_frame(votes).T_a_b.has_value());
}

TEST_CASE("a frame that half as many places contradict is no frame, a single one does no harm") {
  std::vector<PlaceVote> votes;
  for (int i = 0; i < 6; ++i) votes.push_back(vote(10.0 * i, {{frame(5.0), 1.0}}));
  votes.push_back(vote(60.0, {{frame(-8.0), 1.0}}));
  CHECK(common_frame(votes).T_a_b.has_value());
  for (int i = 7; i < 11; ++i) votes.push_back(vote(10.0 * i, {{frame(-8.0), 1.0}}));
  CHECK_FALSE(common_frame(votes).T_a_b.has_value());
}

TEST_CASE("places that are ambiguous one by one are certain together") {
  // Each place may also be elsewhere, and each elsewhere differently.
  std::vector<PlaceVote> votes;
  for (int i = 0; i < 4; ++i) {
    votes.push_back(vote(10.0 * i, {{frame(30.0 * i - 70.0), 0.5}, {frame(5.0), 0.5}}));
  }
  const FrameVerdict verdict = common_frame(votes);
  REQUIRE(verdict.T_a_b.has_value());
  CHECK(verdict.T_a_b->translation().x() == doctest::Approx(5.0));
  // Two frames on which all agree stay ambiguous.
  for (PlaceVote& one : votes) one.hypotheses.front().T_a_b = frame(-20.0);
  CHECK_FALSE(common_frame(votes).T_a_b.has_value());
}

TEST_CASE("frames agree within what B has drifted between the places, and not beyond") {
  const auto agreeing = [](double apart_m) {
    const std::vector<PlaceVote> votes{vote(0.0, {{frame(5.0), 1.0}}),
                                       vote(100.0, {{frame(5.0 + apart_m), 1.0}})};
    return common_frame(votes).agreeing.size();
  };
  CHECK(agreeing(2.0) == 2);
  CHECK(agreeing(3.0) == 1);
}

}  // namespace
}  // namespace isobar::test::test_frame_vote
