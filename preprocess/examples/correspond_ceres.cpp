// Ceres behind correspond.h: least squares over both phases and the alignment of every pair of one correspondence.
extern "C" {
#include "preprocess/examples/correspond.h"
#include "runtime/core/base/fail.h"
}

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace
{

using knot =
    std::array<double, 5>; // phase of the first cycle, phase of the second, turn, shift left, shift forward
constexpr double stay = 0.005; // m per cycle of phase: keeps pairs from sliding along a valley without slope
constexpr double even =
    0.02; // m per cycle of phase: keeps the warp from one pair to the next near one to one

// The windows of one pair, point by point, weighted as in the map.
class window_residual final : public ceres::SizedCostFunction<ceres::DYNAMIC, 5>
{
  public:
    window_residual(const ff_point_cycle *first, const ff_point_cycle *second)
        : first_(first), second_(second)
    {
        set_num_residuals(3 * FF_WINDOW * first->point_count);
        for (int i = 0; i < FF_WINDOW; ++i)
            for (int p = 0; p < first->point_count; ++p)
                total_ += first->weights[p];
    }

    bool Evaluate(double const *const *parameters, double *residuals, double **jacobians) const override
    {
        const double *k = parameters[0];
        const int count = first_->point_count;
        ff_vec3 a[FF_CLOUD_MAX], b[FF_CLOUD_MAX], da[FF_CLOUD_MAX], db[FF_CLOUD_MAX];
        ff_cycle_window(first_, k[0], a, da);
        ff_cycle_window(second_, k[1], b, db);
        const double s = ff_sin(k[2]), c = ff_cos(k[2]);
        double *jacobian = jacobians ? jacobians[0] : nullptr;
        for (int i = 0; i < FF_WINDOW * count; ++i) {
            const double w = std::sqrt(first_->weights[i % count] / total_);
            const double x = b[i].x * c + b[i].z * s, z = b[i].z * c - b[i].x * s;
            residuals[3 * i] = w * (a[i].x - x - k[3]);
            residuals[3 * i + 1] = w * (a[i].y - b[i].y);
            residuals[3 * i + 2] = w * (a[i].z - z - k[4]);
            if (!jacobian) continue;
            const double rows[3][5] = {{da[i].x, -(db[i].x * c + db[i].z * s), -z, -1.0, 0.0},
                                       {da[i].y, -db[i].y, 0.0, 0.0, 0.0},
                                       {da[i].z, -(db[i].z * c - db[i].x * s), x, 0.0, -1.0}};
            for (int r = 0; r < 3; ++r)
                for (int p = 0; p < 5; ++p)
                    jacobian[(3 * i + r) * 5 + p] = w * rows[r][p];
        }
        return true;
    }

  private:
    const ff_point_cycle *first_, *second_;
    double total_ = 0.0;
};

// A pair does not go far along the warp when nothing tells it where to be.
struct stay_residual {
    double phase[2];
    template <typename T>
    bool operator()(const T *k, T *residual) const
    {
        residual[0] = stay * (k[0] + k[1] - phase[0] - phase[1]);
        return true;
    }
};

// Both cycles advance alike from one pair to the next; turns = whole cycles between the two as they are numbered.
struct even_residual {
    double turns[2];
    template <typename T>
    bool operator()(const T *k, const T *next, T *residual) const
    {
        residual[0] = even * ((next[1] - k[1] + turns[1]) - (next[0] - k[0] + turns[0]));
        return true;
    }
};

void refine(const ff_point_cycle *first, const ff_point_cycle *second, double reach, ff_cycle_pairs *pairs)
{
    const int n = pairs->count;
    std::vector<knot> knots(static_cast<size_t>(n));
    ceres::Problem problem;
    for (int i = 0; i < n; ++i) {
        const ff_cycle_pair &pair = pairs->pair[i];
        ff_vec3 a[FF_CLOUD_MAX], b[FF_CLOUD_MAX];
        ff_cycle_window(first, pair.phase[0], a, nullptr);
        ff_cycle_window(second, pair.phase[1], b, nullptr);
        const ff_alignment start =
            ff_cloud_align(a, b, first->weights, first->point_count, FF_WINDOW * first->point_count);
        knot &k = knots[static_cast<size_t>(i)];
        k = {pair.phase[0], pair.phase[1], start.turn, start.shift.b, start.shift.a};
        problem.AddResidualBlock(new window_residual(first, second), nullptr, k.data());
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<stay_residual, 1, 5>(
                                     new stay_residual{{pair.phase[0], pair.phase[1]}}),
                                 nullptr, k.data());
        for (int side = 0; side < 2; ++side) {
            problem.SetParameterLowerBound(k.data(), side, pair.phase[side] - reach);
            problem.SetParameterUpperBound(k.data(), side, pair.phase[side] + reach);
        }
    }
    for (int i = 0; i < n && n > 1; ++i) {
        const int next = (i + 1) % n;
        even_residual *link = new even_residual{{0.0, 0.0}};
        for (int side = 0; side < 2; ++side)
            link->turns[side] = pairs->pair[next].phase[side] < pairs->pair[i].phase[side] ? 1.0 : 0.0;
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<even_residual, 1, 5, 5>(link), nullptr,
                                 knots[static_cast<size_t>(i)].data(),
                                 knots[static_cast<size_t>(next)].data());
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 6;
    options.function_tolerance = 1e-4;
    options.num_threads = 1; // one correspondence per thread already, and the same bits always
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) return; // the minima of the map stay as they are
    for (int i = 0; i < n; ++i)
        for (int side = 0; side < 2; ++side)
            pairs->pair[i].phase[side] = knots[static_cast<size_t>(i)][static_cast<size_t>(side)];
}

} // namespace

ff_status ff_correspond_refine(const ff_point_cycle *first, const ff_point_cycle *second, double reach,
                               ff_cycle_pairs *pairs, ff_error *error)
{
    try {
        refine(first, second, reach, pairs);
        return FF_OK;
    } catch (...) {
        return ff_fail(error, FF_ERR_NO_MEMORY, "refining correspondences");
    }
}
