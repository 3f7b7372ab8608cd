// SPDX-License-Identifier: BSD-3-Clause
// Models of pressure compensation, ordered by how much data a fit needs.
#pragma once

#include <cstdint>

#include "core/altitude/compensation.hpp"
#include "core/name_table.hpp"

namespace isobar {

/// Simplest first. The paper's models, preceded by two simpler ones.
enum class CompensationModel : std::uint8_t {
  kNone,    ///< identity (the paper's A'_m: the sensor has applied its factory coefficients)
  kOffset,  ///< constant offset: the least that two sensors side by side need
  kP,       ///< cubic in pressure
  kSimple,  ///< kP, linear in temperature
  kInd,     ///< kP, cubic in temperature, no cross terms
  kM,       ///< kP, linear in temperature with cross terms up to u^2 v
  kFull,    ///< all sixteen coefficients
};

/// Names in configuration, on the command line and in reports.
inline constexpr NameTable<CompensationModel, 7> kCompensationModelNames{{{
    {CompensationModel::kNone, "none"},
    {CompensationModel::kOffset, "offset"},
    {CompensationModel::kP, "A_p"},
    {CompensationModel::kSimple, "A_simple"},
    {CompensationModel::kInd, "A_ind"},
    {CompensationModel::kM, "A_m"},
    {CompensationModel::kFull, "A_full"},
}}};

/// Free coefficients of the correction p_cal - p_raw. For the paper's models these are also the free
/// coefficients of p_cal; kOffset fixes the slope at 1, kNone fixes everything.
CompensationMask free_coefficients(CompensationModel model);

/// Whether any free coefficient multiplies the temperature.
bool uses_temperature(CompensationModel model);

}  // namespace isobar
