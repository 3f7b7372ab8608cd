// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "drivers/encoder/quadrature.hpp"
#include "tests/drivers/encoder/turning_wheel.hpp"

namespace isobar::test::test_quadrature {

using namespace isobar::encoder;
using isobar::encoder::TurningWheel;

namespace {

/// Edges of a wheel that turns steadily.
std::vector<Edge> steady(bool forward, int quarters, int from) {
  TurningWheel wheel;
  for (int i = 0; i < from; ++i) (void)wheel.turn(true, 0);
  std::vector<Edge> edges;
  for (int i = 0; i < quarters; ++i) edges.push_back(wheel.turn(forward, i));
  return edges;
}

QuadratureDecoder started(int from) {
  TurningWheel wheel;
  for (int i = 0; i < from; ++i) (void)wheel.turn(true, 0);
  QuadratureDecoder decoder;
  decoder.start(wheel.a(), wheel.b());
  return decoder;
}

}  // namespace

TEST_CASE("every quarter of a period is one count, in both directions and from every position") {
  for (const bool forward : {true, false}) {
    for (int from = 0; from < 4; ++from) {
      QuadratureDecoder decoder = started(from);
      for (const Edge& edge : steady(forward, 1'000, from)) decoder.add(edge);
      CHECK(decoder.count() == (forward ? 1'000 : -1'000));
      CHECK(decoder.counters().lost == 0);
      CHECK(decoder.counters().edges == 1'000);
    }
  }
}

TEST_CASE("any way there and back is counted exactly") {
  std::mt19937 random(11);
  TurningWheel wheel;
  QuadratureDecoder decoder;
  decoder.start(wheel.a(), wheel.b());
  for (int i = 0; i < 100'000; ++i) {
    decoder.add(wheel.turn(random() % 3 != 0, i));
    REQUIRE(decoder.count() == wheel.position());
  }
  CHECK(decoder.counters().lost == 0);
}

TEST_CASE("a lost edge of a steady turn is noticed within a period and its count restored") {
  for (const bool forward : {true, false}) {
    for (int from = 0; from < 4; ++from) {
      for (std::size_t lost = 4; lost < 12; ++lost) {
        QuadratureDecoder decoder = started(from);
        std::vector<Edge> edges = steady(forward, 40, from);
        edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(lost));
        for (const Edge& edge : edges) decoder.add(edge);
        CHECK(decoder.count() == (forward ? 40 : -40));
        CHECK(decoder.counters().lost == 1);
        CHECK(decoder.counters().restored == 1);
      }
    }
  }
}

TEST_CASE("one edge in a hundred lost from a steady turn: most are noticed, and the way is right to 0.2 %") {
  std::mt19937 random(5);
  QuadratureDecoder decoder = started(0);
  std::uint64_t lost = 0;
  for (const Edge& edge : steady(true, 100'000, 0)) {
    if (random() % 100 == 0) {
      ++lost;
    } else {
      decoder.add(edge);
    }
  }
  CHECK(decoder.counters().lost > lost * 9 / 10);
  CHECK(decoder.counters().lost <= lost);
  CHECK(decoder.count() == doctest::Approx(100'000).epsilon(0.002));
}

TEST_CASE("a line that trembles at one edge, with losses, does not creep") {
  std::mt19937 random(9);
  TurningWheel wheel;
  QuadratureDecoder decoder;
  decoder.start(wheel.a(), wheel.b());
  bool forward = true;
  for (int i = 0; i < 10'000; ++i) {
    const Edge edge = wheel.turn(forward, i);
    forward = !forward;
    if (random() % 10 != 0) decoder.add(edge);
  }
  CHECK(decoder.counters().lost > 500);
  CHECK(decoder.counters().restored == decoder.counters().lost);
  CHECK(std::abs(decoder.count() - wheel.position()) <= 1);
}

TEST_CASE("edges of lines that are read one after the other are used in the order of their stamps") {
  std::mt19937 random(21);
  TurningWheel wheel;
  QuadratureDecoder decoder;
  decoder.start(wheel.a(), wheel.b());
  EdgeSorter sorter;
  std::int64_t time_ns = 0;
  std::vector<Edge> held_back;  // came while the lines were read
  for (int round = 0; round < 2'000; ++round) {
    std::vector<Edge> edges = held_back;
    const auto count = random() % 16;
    for (std::uint32_t i = 0; i < count; ++i)
      edges.push_back(wheel.turn(random() % 4 != 0, time_ns += 50'000));
    const std::int64_t begun_ns = time_ns;
    const Edge late_first = wheel.turn(true, time_ns += 20'000);
    const Edge late_second = wheel.turn(true, time_ns += 20'000);
    // Line A is read before the two late edges, B after: of the late ones only B's is seen in this round.
    edges.push_back(late_first.line == Line::kB ? late_first : late_second);
    held_back = {late_first.line == Line::kB ? late_second : late_first};
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Edge& x, const Edge& y) { return x.line < y.line; });
    for (const Edge& edge : edges) REQUIRE(sorter.add(edge));
    sorter.release(begun_ns, [&](const Edge& edge) { decoder.add(edge); });
  }
  for (const Edge& edge : held_back) REQUIRE(sorter.add(edge));
  sorter.release(time_ns, [&](const Edge& edge) { decoder.add(edge); });
  CHECK(sorter.size() == 0);
  CHECK(decoder.count() == wheel.position());
  CHECK(decoder.counters().lost == 0);
}

TEST_CASE("a full sorter refuses edges and keeps those that it has") {
  EdgeSorter sorter;
  for (std::size_t i = 0; i < EdgeSorter::kCapacity; ++i) {
    CHECK(sorter.add({static_cast<std::int64_t>(EdgeSorter::kCapacity - i), 0, Line::kA, true}));
  }
  CHECK_FALSE(sorter.add({0, 0, Line::kA, true}));
  std::int64_t last_ns = 0;
  sorter.release(1'000'000, [&](const Edge& edge) {
    CHECK(edge.stamp_ns == last_ns + 1);
    last_ns = edge.stamp_ns;
  });
  CHECK(last_ns == static_cast<std::int64_t>(EdgeSorter::kCapacity));
}

}  // namespace isobar::test::test_quadrature
