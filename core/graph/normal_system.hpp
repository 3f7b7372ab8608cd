// SPDX-License-Identifier: BSD-3-Clause
// Sparse normal equations of a pose graph, H step = -g with H = sum J^T J and g = sum J^T e, and marginal covariances.
//
// The order of elimination is that of the approximate minimum degree of the graph of nodes (Amestoy, Davis, Duff, 1996),
// the factor L L^T = H Eigen's. A covariance A^T H^-1 A of a few nodes is |L^-1 A|^2: only the rows of L^-1 A on the paths
// of these nodes to the root of the elimination tree differ from zero (Gilbert and Peierls, 1988), so that its cost hardly
// depends on the size of the graph.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/estimates.hpp"
#include "core/graph/graph_node.hpp"
#include "core/graph/relative_pose_edge.hpp"

namespace isobar {

/// What of a node is unknown.
struct NodeFreedom {
  std::array<std::int8_t, 7> columns{};  ///< of its step
  int count = 0;
};

/// Freedom of a node: `anchored` ones keep their pose.
NodeFreedom freedom_of(bool anchored, bool held_by_gravity, bool has_bias);

/// Two nodes that a factor ties.
using NodePair = std::pair<NodeId, NodeId>;

/// A node in a factor, with the factor's Jacobian by its step.
template <int Rows>
struct NodeTerm {
  NodeId node;
  const NodeJacobian<Rows>& by_step;
};

/// Normal equations of a graph.
class NormalSystem {
 public:
  /// Sets the structure: nodes, and pairs of them that share a factor. The sum is zero.
  void restructure(std::vector<NodeFreedom> nodes, std::span<const NodePair> ties);

  /// Begins a new sum of factors.
  void clear();
  /// Adds a factor of one node, whitened.
  template <int Rows>
  void add(const Eigen::Matrix<double, Rows, 1>& error, NodeTerm<Rows> a) {
    add_block(a.node, a.node, a.by_step.transpose() * a.by_step);
    add_gradient(a.node, a.by_step.transpose() * error);
  }
  /// Adds a factor of two different nodes, whitened; they are one of the ties.
  template <int Rows>
  void add(const Eigen::Matrix<double, Rows, 1>& error, NodeTerm<Rows> a, NodeTerm<Rows> b) {
    add(error, a);
    add(error, b);
    if (position(a.node) < position(b.node)) {
      add_block(a.node, b.node, a.by_step.transpose() * b.by_step);
    } else {
      add_block(b.node, a.node, b.by_step.transpose() * a.by_step);
    }
  }

  /// Factorises the sum; `damping` is that of Levenberg and Marquardt, relative to the diagonal.
  /// @return false where the sum is not positive definite or not finite
  bool factorise(double damping);
  /// Steps of all nodes; fixed directions are zero. After factorise().
  void solve(std::vector<NodeStep>& steps) const;
  /// Covariance of by_a^T step_a + by_b^T step_b as factorised, six rows. Thread-compatible, not const: uses work memory.
  Matrix6d marginal(NodeTerm<6> a, NodeTerm<6> b);

  [[nodiscard]] std::size_t node_count() const { return freedom_.size(); }
  [[nodiscard]] Eigen::Index unknowns() const { return gradient_.size(); }

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  using StepMatrix = Eigen::Matrix<double, 7, 7>;
  struct Block {
    NodeId row = 0;
    int offset = 0;  // of its rows in the values of a column
  };

  void order(std::span<const NodePair> ties);
  void lay_out(std::span<const NodePair> ties);
  [[nodiscard]] int position(NodeId node) const { return position_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] const NodeFreedom& freedom(NodeId node) const {
    return freedom_[static_cast<std::size_t>(node)];
  }
  void add_block(NodeId row, NodeId column, const StepMatrix& block);
  void add_gradient(NodeId node, const NodeStep& gradient);
  int put_rows(NodeTerm<6> term);
  int eliminate(int column, Matrix6d& sum);

  std::vector<NodeFreedom> freedom_;
  std::vector<int> position_;    // of a node in the order of elimination
  std::vector<NodeId> node_at_;  // its inverse
  std::vector<int> first_;       // column of a node's first unknown
  std::vector<std::vector<Block>>
      blocks_;  // of a node's columns, in the order of elimination; the last: its own
  Sparse H_;    // upper triangle
  Eigen::VectorXd gradient_;
  Eigen::SimplicialLLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>> factor_;
  std::vector<Vector6d> work_;  // rows of L^-1 A, zero between calls
};

}  // namespace isobar
