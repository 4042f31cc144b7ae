// Dense, strictly convex quadratic programs of the size that a whole-body controller has.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

namespace stagger::sim {

/// minimise 1/2 x' H x + g' x  subject to  E x = e  and  A x >= a.
/// Rows of E and A are constraints. H has a symmetric, positive definite block for the first
/// variables and a positive diagonal for those after them: that saves most of its factorisation.
struct QpProblem {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::MatrixXd h;         ///< the block; its lower triangle is read
  Eigen::VectorXd diagonal;  ///< of the other variables, may have none
  Eigen::VectorXd g;
  Rows equality;
  Eigen::VectorXd equality_value;
  Rows inequality;
  Eigen::VectorXd inequality_bound;
};

enum class QpStatus : std::uint8_t {
  solved,
  infeasible,   ///< the constraints contradict each other
  not_convex,   ///< H is not positive definite
  out_of_steps  ///< degenerate beyond patience
};

/// Dual active-set method of Goldfarb and Idnani (Mathematical Programming 27, 1983): starts from
/// the optimum under the equalities and takes in the most violated constraint until none is left.
/// Memory is kept between calls: none is taken once a size has been seen.
class QpSolver {
 public:
  QpStatus solve(const QpProblem& problem);

  const Eigen::VectorXd& solution() const { return x_; }
  /// Multipliers of the inequalities (>= 0), in their order.
  Eigen::VectorXd inequality_multipliers() const;
  int iterations() const { return iterations_; }

 private:
  /// J and the optimum without constraints; false when H is not positive definite.
  bool factorise(const QpProblem& problem);
  /// Takes in all equalities; false when they depend on each other.
  bool add_equalities(const QpProblem& problem);
  /// Takes in the constraint that directions() was last called for; false when its normal depends
  /// on the active ones.
  bool add_constraint();
  void drop(Eigen::Index position);
  /// Steps of the variables and of the active multipliers towards a constraint of this normal.
  void directions(const Eigen::Ref<const Eigen::VectorXd>& normal);
  /// Turns the columns of J from `first` on so that d is zero after that entry.
  void reflect(Eigen::Index first);

  Eigen::Index n_ = 0;
  Eigen::Index active_count_ = 0;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::MatrixXd j_;  ///< H^-1/2 Q: its first active_count_ columns span the active normals
  Eigen::MatrixXd r_;  ///< upper triangular factor of the active normals in that basis
  Eigen::VectorXd x_;
  Eigen::VectorXd d_;       ///< J' n
  Eigen::VectorXd primal_;  ///< step of x
  Eigen::VectorXd dual_;    ///< step of the active multipliers
  Eigen::VectorXd u_;       ///< multipliers of the active inequalities
  Eigen::VectorXd slack_;
  Eigen::VectorXd turned_;            ///< work space of reflect()
  std::vector<Eigen::Index> active_;  ///< an inequality's index, or -1 for an equality
  std::vector<char> is_active_;
  Eigen::Index inequalities_ = 0;
  int iterations_ = 0;
};

}  // namespace stagger::sim
