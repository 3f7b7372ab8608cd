// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/compensation_model.hpp"

#include <array>

namespace isobar {

CompensationMask free_coefficients(CompensationModel model) {
  constexpr std::array<CompensationMask, 7> kFree = {0,      coefficient(0, 0), kMaskP, kMaskSimple, kMaskInd,
                                                     kMaskM, kMaskFull};
  const auto index = static_cast<std::size_t>(model);
  return index < kFree.size() ? kFree[index] : CompensationMask{0};
}

bool uses_temperature(CompensationModel model) {
  return (free_coefficients(model) & static_cast<CompensationMask>(~kMaskP)) != 0;
}

}  // namespace isobar
