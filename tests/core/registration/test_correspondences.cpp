// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstddef>
#include <span>
#include <vector>

#include "core/registration/correspondences.hpp"

namespace isobar::test::test_correspondences {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)

// A map that finds each point on a plane through itself and records which points had a match before.
class NotingMap final : public MapSnapshot {
 public:
  NotingMap() : MapSnapshot(0.25F, 1) {}

  void match(const MatchQuery& /*query*/, std::span<const Eigen::Vector3f> p_local,
             std::span<PlaneMatch> matches) const override {
    known_.clear();
    for (std::size_t i = 0; i < p_local.size(); ++i) {
      known_.push_back(matches[i].found && matches[i].p_searched == p_local[i]);
      matches[i].found = true;
      matches[i].p_searched = matches[i].q_local = p_local[i];
      matches[i].normal = Eigen::Vector3f::UnitZ();
    }
  }
  [[nodiscard]] const std::vector<bool>& known() const { return known_; }

 private:
  mutable std::vector<bool> known_;  // per point of the last call
};

// A map in which the first `own` points have a plane of their own, one has none, and all others an extrapolated one.
class ExtrapolatingMap final : public MapSnapshot {
 public:
  explicit ExtrapolatingMap(std::size_t own) : MapSnapshot(0.25F, 1), own_(own) {}

  void match(const MatchQuery& /*query*/, std::span<const Eigen::Vector3f> p_local,
             std::span<PlaneMatch> matches) const override {
    for (std::size_t i = 0; i < p_local.size(); ++i) {
      matches[i].found = i != own_;
      matches[i].in_own_cell = i < own_;
      matches[i].q_local = p_local[i];
      matches[i].normal = i < own_ ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitZ();
    }
  }

 private:
  std::size_t own_;
};

}  // namespace

TEST_CASE("extrapolated planes are left out on request, unless hardly any point has a plane of its own") {
  const std::vector<Eigen::Vector3f> p_base(101, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  const auto pairs_of = [&](std::size_t own, PairChoice choice) {
    const ExtrapolatingMap map(own);
    Correspondences correspondences(p_base.size());
    correspondences.start(map, Eigen::Vector3d::Zero());
    const auto pairs = correspondences.find(map, p_base, 1, Eigen::Isometry3d::Identity(),
                                            Eigen::Vector3d::Zero(), 1.0, choice);
    CHECK(correspondences.matched() == 100);
    return std::vector<Pair>(pairs.begin(), pairs.end());
  };
  CHECK(pairs_of(20, PairChoice::kNearest).size() == 100);
  const std::vector<Pair> own = pairs_of(30, PairChoice::kOwnCell);
  REQUIRE(own.size() == 30);
  for (const Pair& pair : own) CHECK(pair.normal == Eigen::Vector3f::UnitX());
  CHECK(pairs_of(20, PairChoice::kOwnCell).size() == 100);
}

TEST_CASE("points of the coarse stride keep their match in the fine one, all others start without") {
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{100}, std::size_t{101}}) {
    std::vector<Eigen::Vector3f> p_base;
    for (std::size_t i = 0; i < count; ++i) p_base.emplace_back(static_cast<float>(i), 1.0F, 2.0F);
    const NotingMap map;
    Correspondences correspondences(count);
    correspondences.start(map, Eigen::Vector3d::Zero());
    const auto look = [&](std::size_t stride) {
      const auto pairs = correspondences.find(map, p_base, stride, Eigen::Isometry3d::Identity(),
                                              Eigen::Vector3d::Zero(), 1.0);
      REQUIRE(pairs.size() == (count + stride - 1) / stride);
      return map.known();
    };
    const auto every = [&](std::size_t n) {
      std::vector<bool> members;
      for (std::size_t i = 0; i < count; ++i) members.push_back(i % n == 0);
      return members;
    };
    CHECK(look(6) == std::vector<bool>((count + 5) / 6, false));
    CHECK(look(6) == std::vector<bool>((count + 5) / 6, true));
    look(3);
    CHECK(look(1) == every(3));
    CHECK(look(1) == std::vector<bool>(count, true));
    // From fine to coarse, and from scan to scan, no match is kept.
    CHECK(look(3) == std::vector<bool>((count + 2) / 3, false));
    correspondences.start(map, Eigen::Vector3d::Zero());
    CHECK(look(3) == std::vector<bool>((count + 2) / 3, false));
  }
}

}  // namespace isobar::test::test_correspondences
