// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lidar/blind_sector.hpp"

#include <algorithm>

#include "drivers/lidar/lidar_decoder.hpp"

namespace isobar {

namespace {

std::uint32_t apart(std::uint32_t a, std::uint32_t b) {
  return std::min(turn_between(a, b), turn_between(b, a));
}

}  // namespace

std::uint32_t BlindSector::add(std::uint32_t from, std::uint32_t to, std::uint32_t lost) {
  const std::uint32_t step = turn_between(from, to);
  if (step > kFullTurn - kLeast) return 0;  // a step back: reordered, or the motor's jitter
  if (known_ && (holds(from) || holds(to))) *this = {};
  swept_ = std::min(swept_ + step, 2 * kFullTurn);
  if (step < kLeast) return 0;
  const bool again = seen_ && is_same(from, step) && apart(swept_, kFullTurn) <= 2 * kTolerance;
  if (known_ && !again) return 0;  // beside the sector, or across it and more: loss
  const bool awaited = seen_ && swept_ + 2 * kTolerance < kFullTurn;
  if (awaited && step <= width_) return 0;  // a shorter gap before the candidate's turn is over: loss
  const std::uint32_t recounted = again && !known_ ? lost_ + lost : 0;
  known_ = again;
  seen_ = true;
  from_ = from;
  width_ = step;
  lost_ = lost;
  swept_ = 0;
  return recounted;
}

bool BlindSector::crossed(std::uint32_t from, std::uint32_t to) const {
  return known_ && turn_between(from, to) >= width_ / 2 && turn_between(from, to) <= kFullTurn - kLeast &&
         turn_between(from, from_ + width_ / 2) <= turn_between(from, to);
}

bool BlindSector::holds(std::uint32_t turn) const {
  const std::uint32_t inside = turn_between(from_, turn);
  return known_ && inside > kTolerance && inside + kTolerance < width_;
}

bool BlindSector::is_same(std::uint32_t from, std::uint32_t width) const {
  return apart(from, from_) <= kTolerance && apart(from + width, from_ + width_) <= kTolerance;
}

}  // namespace isobar
