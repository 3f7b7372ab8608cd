// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "run/evaluation/evaluated_run.hpp"
#include "tools/report/stroke.hpp"

namespace isobar::report {

/// Style of a method's lines and boxes: fixed for the six methods, from a list for other names. Palette of
/// Okabe and Ito (2008), which colour-blind readers can tell apart; dashes tell lines apart without colour.
Stroke method_stroke(const evaluation::EvaluatedRun& run, const evaluation::EvaluatedMethod& method);

inline const Stroke kReferenceStroke{"--muted", 1.4, "6 4"};
inline const Stroke kAltimeterStroke{"#38a3dd", 1.8, "2 3"};

}  // namespace isobar::report
