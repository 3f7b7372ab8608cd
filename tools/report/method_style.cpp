// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/method_style.hpp"

#include <array>
#include <map>

namespace isobar::report {

Stroke method_stroke(const evaluation::EvaluatedRun& run, const evaluation::EvaluatedMethod& method) {
  static const std::map<std::string, Stroke> kKnown{{"adaptive", {"--ink", 2.2}},
                                                    {"3dof", {"#0072b2", 2.0}},
                                                    {"4dof", {"#d55e00", 1.8}},
                                                    {"6dof", {"#aa3a86", 1.8}},
                                                    {"4dof-altitude", {"#009e73", 1.6, "8 3"}},
                                                    {"6dof-altitude", {"#b07d00", 1.6, "8 3"}},
                                                    {"odometry", {"#6b7280", 1.6, "3 3"}}};
  static const std::array<Stroke, 6> kOthers{{{"#0072b2", 2.0},
                                              {"#d55e00", 1.8},
                                              {"#009e73", 1.6, "8 3"},
                                              {"#aa3a86", 1.8, "3 3"},
                                              {"#b07d00", 1.6, "8 3 2 3"},
                                              {"#6b7280", 1.6}}};
  const auto known = kKnown.find(method.name);
  if (known != kKnown.end()) return known->second;
  const auto index = static_cast<std::size_t>(&method - run.methods.data());
  return kOthers[index % kOthers.size()];
}

}  // namespace isobar::report
