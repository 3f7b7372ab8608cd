// SPDX-License-Identifier: BSD-3-Clause
// The models of pressure compensation by name, in the order of how much they ask of the data.
#pragma once

#include <array>
#include <cstdint>

#include "core/altitude/compensation.hpp"

namespace isobar {

enum class CompensationModel : std::uint8_t { kNone, kOffset, kP, kSimple, kInd, kM, kFull };

/// All models, simplest first. kNone is the sensor as it is (the paper's A'_m, where the sensor has computed
/// its pressure from the factory's coefficients); kOffset is what any sensor needs that stands beside
/// another; the rest are the paper's.
inline constexpr std::array<CompensationModel, 7> kCompensationModels = {
    CompensationModel::kNone, CompensationModel::kOffset, CompensationModel::kP,   CompensationModel::kSimple,
    CompensationModel::kInd,  CompensationModel::kM,      CompensationModel::kFull};

/// As configuration and command line spell it: "none", "offset", "A_p", "A_simple", "A_ind", "A_m", "A_full".
const char* model_name(CompensationModel model);

/// Which coefficients of the correction p_cal - p_raw a fit may choose. With the paper's models that is the
/// same as choosing those of p_cal; kOffset leaves the slope at one, kNone everything.
CompensationMask free_coefficients(CompensationModel model);

/// How many those are.
int free_coefficient_count(CompensationModel model);

/// Whether the temperature takes part.
bool uses_temperature(CompensationModel model);

}  // namespace isobar
