// SPDX-License-Identifier: BSD-3-Clause
#include "core/graph/normal_system.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>

namespace isobar {

namespace {

// Information of every unknown by itself [1/m^2, 1/rad^2]: 1 km, and no knowledge of an angle. What no factor holds stays
// where it is; next to any factor (0.1 km: 100 times as much) it is nothing.
constexpr double kLeastInformation = 1e-6;

}  // namespace

NodeFreedom freedom_of(bool anchored, bool held_by_gravity, bool has_bias) {
  NodeFreedom freedom;
  for (const int column : {0, 1, 2, 3, 4, 5, kBiasColumn}) {
    const bool is_tilt = column == 3 || column == 4;
    const bool is_free = column == kBiasColumn ? has_bias : !anchored && !(held_by_gravity && is_tilt);
    if (is_free) {
      freedom.columns[static_cast<std::size_t>(freedom.count++)] = static_cast<std::int8_t>(column);
    }
  }
  return freedom;
}

void NormalSystem::restructure(std::vector<NodeFreedom> nodes, std::span<const NodePair> ties) {
  freedom_ = std::move(nodes);
  order(ties);
  lay_out(ties);
  factor_.setShift(kLeastInformation);
  factor_.analyzePattern(H_);
  work_.assign(static_cast<std::size_t>(gradient_.size()), Vector6d::Zero());
}

void NormalSystem::order(std::span<const NodePair> ties) {
  const auto count = static_cast<Eigen::Index>(freedom_.size());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(freedom_.size() + 2 * ties.size());
  for (int node = 0; node < count; ++node) entries.emplace_back(node, node, 1.0);
  for (const auto& [a, b] : ties) {
    entries.emplace_back(a, b, 1.0);
    entries.emplace_back(b, a, 1.0);
  }
  Sparse pattern(count, count);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  node_at_.assign(permutation.indices().begin(), permutation.indices().end());
  position_.resize(freedom_.size());
  first_.resize(freedom_.size());
  int column = 0;
  for (std::size_t p = 0; p < node_at_.size(); ++p) {
    const auto node = static_cast<std::size_t>(node_at_[p]);
    position_[node] = static_cast<int>(p);
    first_[node] = column;
    column += freedom_[node].count;
  }
  gradient_.setZero(column);
}

void NormalSystem::lay_out(std::span<const NodePair> ties) {
  blocks_.assign(freedom_.size(), {});
  for (std::size_t node = 0; node < freedom_.size(); ++node) blocks_[node] = {{static_cast<NodeId>(node)}};
  for (const auto& [a, b] : ties) {
    const bool a_first = position(a) < position(b);
    blocks_[static_cast<std::size_t>(a_first ? b : a)].push_back({a_first ? a : b});
  }
  std::vector<int> inner;
  std::vector<int> outer{0};
  for (const NodeId node : node_at_) {
    auto& blocks = blocks_[static_cast<std::size_t>(node)];
    const auto earlier = [&](const Block& x, const Block& y) { return position(x.row) < position(y.row); };
    std::sort(blocks.begin(), blocks.end(), earlier);
    const auto same = [](const Block& x, const Block& y) { return x.row == y.row; };
    blocks.erase(std::unique(blocks.begin(), blocks.end(), same), blocks.end());
    int offset = 0;
    for (Block& block : blocks) {
      block.offset = offset;
      offset += freedom(block.row).count;
    }
    for (int k = 0; k < freedom(node).count; ++k) {
      for (const Block& block : blocks) {
        const int rows = block.row == node ? k + 1 : freedom(block.row).count;
        for (int i = 0; i < rows; ++i) inner.push_back(first_[static_cast<std::size_t>(block.row)] + i);
      }
      outer.push_back(static_cast<int>(inner.size()));
    }
  }
  const std::vector<double> zeros(inner.size(), 0.0);
  H_ = Eigen::Map<const Sparse>(gradient_.size(), gradient_.size(), static_cast<int>(inner.size()),
                                outer.data(), inner.data(), zeros.data());
}

void NormalSystem::clear() {
  std::fill_n(H_.valuePtr(), H_.nonZeros(), 0.0);
  gradient_.setZero();
}

void NormalSystem::add_block(NodeId row, NodeId column, const StepMatrix& block) {
  const auto& blocks = blocks_[static_cast<std::size_t>(column)];
  const auto earlier = [&](const Block& x, int at) { return position(x.row) < at; };
  const int offset = std::lower_bound(blocks.begin(), blocks.end(), position(row), earlier)->offset;
  const NodeFreedom& rows = freedom(row);
  const NodeFreedom& columns = freedom(column);
  for (int k = 0; k < columns.count; ++k) {
    double* values =
        H_.valuePtr() + H_.outerIndexPtr()[first_[static_cast<std::size_t>(column)] + k] + offset;
    const int count = row == column ? k + 1 : rows.count;
    for (int i = 0; i < count; ++i) {
      values[i] +=
          block(rows.columns[static_cast<std::size_t>(i)], columns.columns[static_cast<std::size_t>(k)]);
    }
  }
}

void NormalSystem::add_gradient(NodeId node, const NodeStep& gradient) {
  const NodeFreedom& rows = freedom(node);
  double* values = gradient_.data() + first_[static_cast<std::size_t>(node)];
  for (int i = 0; i < rows.count; ++i) values[i] += gradient(rows.columns[static_cast<std::size_t>(i)]);
}

bool NormalSystem::factorise(double damping) {
  if (damping > 0.0) {
    for (Eigen::Index k = 0; k < H_.cols(); ++k) {
      H_.valuePtr()[H_.outerIndexPtr()[k + 1] - 1] *=
          1.0 + damping;  // the last entry of a column: its diagonal
    }
  }
  factor_.factorize(H_);
  return factor_.info() == Eigen::Success && gradient_.allFinite();
}

void NormalSystem::solve(std::vector<NodeStep>& steps) const {
  const Eigen::VectorXd solution = factor_.solve(-gradient_);
  steps.assign(freedom_.size(), NodeStep::Zero());
  for (std::size_t node = 0; node < freedom_.size(); ++node) {
    for (int i = 0; i < freedom_[node].count; ++i) {
      steps[node](freedom_[node].columns[static_cast<std::size_t>(i)]) = solution(first_[node] + i);
    }
  }
}

// Writes a node's rows of A. Returns its first column, or the number of columns for a node without unknowns.
int NormalSystem::put_rows(NodeTerm<6> term) {
  const NodeFreedom& rows = freedom(term.node);
  if (rows.count == 0) return static_cast<int>(gradient_.size());
  const int first = first_[static_cast<std::size_t>(term.node)];
  const auto row = static_cast<std::size_t>(first);
  for (std::size_t i = 0; i < static_cast<std::size_t>(rows.count); ++i) {
    work_[row + i] += term.by_step.col(rows.columns[i]);
  }
  return first;
}

// One row of L^-1 A: takes it out of the work memory and into the sum. Returns the next column on the path to the root.
int NormalSystem::eliminate(int column, Matrix6d& sum) {
  const Sparse& L = factor_.matrixL().nestedExpression();
  const int begin = L.outerIndexPtr()[column];
  const int end = L.outerIndexPtr()[column + 1];
  const Vector6d x = work_[static_cast<std::size_t>(column)] / L.valuePtr()[begin];
  work_[static_cast<std::size_t>(column)].setZero();
  sum += x * x.transpose();
  for (int p = begin + 1; p < end; ++p) {
    work_[static_cast<std::size_t>(L.innerIndexPtr()[p])] -= L.valuePtr()[p] * x;
  }
  return begin + 1 < end ? L.innerIndexPtr()[begin + 1] : static_cast<int>(L.cols());
}

Matrix6d NormalSystem::marginal(NodeTerm<6> a, NodeTerm<6> b) {
  Matrix6d sum = Matrix6d::Zero();
  int at_a = put_rows(a);
  int at_b = put_rows(b);
  // Both paths at once, each column after those before it.
  for (int column = std::min(at_a, at_b); column < gradient_.size(); column = std::min(at_a, at_b)) {
    const int next = eliminate(column, sum);
    if (at_a == column) at_a = next;
    if (at_b == column) at_b = next;
  }
  return sum;
}

}  // namespace isobar
