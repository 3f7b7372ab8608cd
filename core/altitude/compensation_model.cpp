// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/compensation_model.hpp"

#include <bit>

namespace isobar {

const char* model_name(CompensationModel model) {
  switch (model) {
    case CompensationModel::kNone:
      return "none";
    case CompensationModel::kOffset:
      return "offset";
    case CompensationModel::kP:
      return "A_p";
    case CompensationModel::kSimple:
      return "A_simple";
    case CompensationModel::kInd:
      return "A_ind";
    case CompensationModel::kM:
      return "A_m";
    case CompensationModel::kFull:
      return "A_full";
  }
  return "none";
}

CompensationMask free_coefficients(CompensationModel model) {
  switch (model) {
    case CompensationModel::kNone:
      return 0;
    case CompensationModel::kOffset:
      return coefficient(0, 0);
    case CompensationModel::kP:
      return kMaskP;
    case CompensationModel::kSimple:
      return kMaskSimple;
    case CompensationModel::kInd:
      return kMaskInd;
    case CompensationModel::kM:
      return kMaskM;
    case CompensationModel::kFull:
      return kMaskFull;
  }
  return 0;
}

int free_coefficient_count(CompensationModel model) { return std::popcount(free_coefficients(model)); }

bool uses_temperature(CompensationModel model) {
  return (free_coefficients(model) & static_cast<CompensationMask>(~kMaskP)) != 0;
}

}  // namespace isobar
