// SPDX-License-Identifier: BSD-3-Clause
// Relative errors over windows of a fixed length of travel: drift, independent of earlier errors.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "run/evaluation/association.hpp"
#include "run/evaluation/segments.hpp"

namespace isobar::evaluation {

/// Windows start every `start_step_m` of travel, so that neither a robot at rest nor a higher pose rate gets
/// more weight, and end at the first pose `length_m` further along the reference. Windows longer by more than
/// a tenth, and than 1.5 usual steps of the pairs (a gap in the estimate), are left out.
struct WindowOptions {
  double length_m = 5.0;
  double start_step_m = 0.1;
};

/// Indices of the first and last pair, and the reference's travel between them.
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
  double travelled_m = 0.0;
};

/// All windows that lie entirely within one segment; over the whole run if `segments` is null.
std::vector<Window> make_windows(const std::vector<PosePair>& pairs, const std::vector<Segment>* segments,
                                 const WindowOptions& options);

/// |dz_estimate - dz_reference| / travelled distance of each window, 0 … [1]. The paper's relative error on z
/// (Dubois et al., "Under Pressure", Experiments, with length_m = 5 on flat floors).
std::vector<double> relative_z_error(const std::vector<PosePair>& pairs, const std::vector<Window>& windows);

/// Relative pose error of one window: E = (A_ref^-1 B_ref)^-1 (A_est^-1 B_est) (Sturm et al. 2012, eq. 2),
/// per metre of travel.
struct RelativePoseError {
  double translation = 0.0;     ///< |t(E)| / travelled distance [1]
  double rotation_rad_m = 0.0;  ///< angle(E) / travelled distance
};
std::vector<RelativePoseError> relative_pose_error(const std::vector<PosePair>& pairs,
                                                   const std::vector<Window>& windows);

}  // namespace isobar::evaluation
