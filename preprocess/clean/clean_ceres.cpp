// Ceres behind clean_problem.h. One thread, no limit in wall-clock time, fixed order of blocks and terms: the same
// problem gives the same bits.
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include <cmath>

extern "C" {
#include "preprocess/clean/clean_problem.h"
#include "runtime/core/base/fail.h"
}

namespace
{

const int MOST_ITERATIONS = 40;
const double TOLERANCE = 1e-4; // cleanup study, section 2: 1e-3 to 1e-8 give the same quality

// Keep N unknowns where they were.
template <int N>
class Close : public ceres::SizedCostFunction<N, N>
{
  public:
    Close(const double *wanted, const double *per_sigma, double weight)
    {
        for (int i = 0; i < N; ++i) {
            wanted_[i] = wanted ? wanted[i] : 0.0;
            scale_[i] = weight * per_sigma[i];
        }
    }
    bool Evaluate(double const *const *x, double *residuals, double **slopes) const override
    {
        for (int i = 0; i < N; ++i)
            residuals[i] = scale_[i] * (x[0][i] - wanted_[i]);
        if (!slopes || !slopes[0]) return true;
        for (int i = 0; i < N * N; ++i)
            slopes[0][i] = i % (N + 1) == 0 ? scale_[i % N] : 0.0;
        return true;
    }

  private:
    double wanted_[N], scale_[N];
};

// Second difference over time squared, of N unknowns at three knots.
template <int N>
class Smooth : public ceres::SizedCostFunction<N, N, N, N>
{
  public:
    Smooth(const double *per_sigma, double weight)
    {
        for (int i = 0; i < N; ++i)
            scale_[i] = weight * per_sigma[i];
    }
    bool Evaluate(double const *const *x, double *residuals, double **slopes) const override
    {
        for (int i = 0; i < N; ++i)
            residuals[i] = scale_[i] * (x[0][i] - 2.0 * x[1][i] + x[2][i]);
        for (int block = 0; slopes && block < 3; ++block) {
            if (!slopes[block]) continue;
            double factor = block == 1 ? -2.0 : 1.0;
            for (int i = 0; i < N * N; ++i)
                slopes[block][i] = i % (N + 1) == 0 ? factor * scale_[i % N] : 0.0;
        }
        return true;
    }

  private:
    double scale_[N];
};

class Pin : public ceres::SizedCostFunction<6, FF_CLEAN_ROOT, FF_CLEAN_LEG, FF_CLEAN_PLANT>
{
  public:
    Pin(const ff_clean_problem *problem, int knot, int side) : problem_(problem), knot_(knot), side_(side) {}
    bool Evaluate(double const *const *x, double *residuals, double **slopes) const override
    {
        ff_clean_pin_term(problem_, knot_, side_, x[0], x[1], x[2], residuals, slopes);
        return true;
    }

  private:
    const ff_clean_problem *problem_;
    int knot_, side_;
};

class Ground : public ceres::SizedCostFunction<3, FF_CLEAN_ROOT, FF_CLEAN_LEG>
{
  public:
    Ground(const ff_clean_problem *problem, int knot, int side) : problem_(problem), knot_(knot), side_(side)
    {
    }
    bool Evaluate(double const *const *x, double *residuals, double **slopes) const override
    {
        ff_clean_ground_term(problem_, knot_, side_, x[0], x[1], residuals, slopes);
        return true;
    }

  private:
    const ff_clean_problem *problem_;
    int knot_, side_;
};

class Knee : public ceres::SizedCostFunction<1, FF_CLEAN_LEG>
{
  public:
    Knee(const ff_clean_problem *problem, int knot, int side) : problem_(problem), knot_(knot), side_(side) {}
    bool Evaluate(double const *const *x, double *residuals, double **slopes) const override
    {
        ff_clean_knee_term(problem_, knot_, side_, x[0], residuals, slopes);
        return true;
    }

  private:
    const ff_clean_problem *problem_;
    int knot_, side_;
};

void add_plants(ff_clean_problem *p, int first, int last, ceres::Problem &sum)
{
    double tie[FF_CLEAN_PLANT];
    ff_clean_plant_tie(p, tie);
    for (int i = 0; i < p->plant_count; ++i) {
        ff_clean_plant &plant = p->plants[i];
        bool touched = false;
        for (int k = first; k < last && !touched; ++k)
            touched = p->knots[k].plant[0] == i || p->knots[k].plant[1] == i;
        if (!touched) continue;
        sum.AddParameterBlock(plant.at, FF_CLEAN_PLANT);
        if (plant.settled)
            sum.SetParameterBlockConstant(plant.at);
        else
            sum.AddResidualBlock(new Close<FF_CLEAN_PLANT>(plant.tied, tie, 1.0), nullptr, plant.at);
    }
}

// Terms of one knot that is not settled.
void add_knot(ff_clean_problem *p, int k, ceres::Problem &sum)
{
    double weight = ff_clean_knot_weight(p);
    const ff_clean_knot &knot = p->knots[k];
    double *root = p->root[k];
    sum.AddResidualBlock(new Close<FF_CLEAN_ROOT>(nullptr, ff_clean_root_close, weight), nullptr, root);
    for (int side = 0; side < 2; ++side) {
        double *leg = p->legs[k][side];
        sum.AddResidualBlock(new Close<FF_CLEAN_LEG>(nullptr, ff_clean_leg_close, weight), nullptr, leg);
        sum.AddResidualBlock(new Knee(p, k, side), nullptr, leg);
        if (knot.near_ground[side]) sum.AddResidualBlock(new Ground(p, k, side), nullptr, root, leg);
        if (knot.plant[side] >= 0)
            sum.AddResidualBlock(new Pin(p, k, side), nullptr, root, leg, p->plants[knot.plant[side]].at);
    }
}

void add_smoothness(ff_clean_problem *p, int k, ceres::Problem &sum)
{
    double weight = ff_clean_knot_weight(p) / (p->knot_time * p->knot_time);
    sum.AddResidualBlock(new Smooth<FF_CLEAN_ROOT>(ff_clean_root_smooth, weight), nullptr, p->root[k - 1],
                         p->root[k], p->root[k + 1]);
    for (int side = 0; side < 2; ++side)
        sum.AddResidualBlock(new Smooth<FF_CLEAN_LEG>(ff_clean_leg_smooth, weight), nullptr,
                             p->legs[k - 1][side], p->legs[k][side], p->legs[k + 1][side]);
}

ceres::Solver::Options options()
{
    ceres::Solver::Options o;
    o.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    o.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    o.num_threads = 1;
    o.max_num_iterations = MOST_ITERATIONS;
    o.function_tolerance = TOLERANCE;
    o.logging_type = ceres::SILENT;
    return o;
}

} // namespace

ff_status ff_clean_solve(ff_clean_problem *problem, int first, int last, int settled, ff_clean_solution *out,
                         ff_error *error)
try {
    ceres::Problem sum;
    for (int k = first; k < last; ++k) {
        sum.AddParameterBlock(problem->root[k], FF_CLEAN_ROOT);
        for (int side = 0; side < 2; ++side)
            sum.AddParameterBlock(problem->legs[k][side], FF_CLEAN_LEG);
    }
    add_plants(problem, first, last, sum);
    for (int k = first + settled; k < last; ++k)
        add_knot(problem, k, sum);
    for (int k = first + 1; k + 1 < last; ++k)
        add_smoothness(problem, k, sum);
    for (int k = first; k < first + settled; ++k) {
        sum.SetParameterBlockConstant(problem->root[k]);
        for (int side = 0; side < 2; ++side)
            sum.SetParameterBlockConstant(problem->legs[k][side]);
    }
    ceres::Solver::Summary summary;
    ceres::Solve(options(), &sum, &summary);
    out->iterations = static_cast<int>(summary.iterations.size());
    out->converged = summary.termination_type == ceres::CONVERGENCE;
    out->cost = summary.final_cost;
    if (summary.IsSolutionUsable() && std::isfinite(summary.final_cost)) return FF_OK;
    return ff_fail(error, FF_ERR_RANGE, "the clean-up of the feet finds no solution (%s)",
                   summary.message.c_str());
} catch (const std::bad_alloc &) {
    return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory cleaning %d knots", last - first);
} catch (const std::exception &problem_found) {
    return ff_fail(error, FF_ERR_RANGE, "the clean-up of the feet failed: %s", problem_found.what());
}
