#include "preprocess/examples/simplices.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/random.h"

#define FLAT 0.02     /* m/s: points closer than this to a plane or line lie on it */
#define COINCIDE 1e-3 /* m/s */
#define JITTER 1e-5   /* m/s: decides between the diagonals of rectangles, which mirrored examples make */
#define SLIVER 2e-3   /* smallest height of a simplex over its largest face (m/s) */

typedef struct cloud {
    double x[FF_SIMPLICES_MAX_POINTS][3]; /* in the axes of the points' own span, jittered */
    int id[FF_SIMPLICES_MAX_POINTS];
    int count, dimension;
} cloud;

/* Solve the n x n system by Gauss with pivoting; false when it is singular. */
static bool solve(double a[3][4], int n)
{
    for (int c = 0; c < n; ++c) {
        int pivot = c;
        for (int r = c + 1; r < n; ++r)
            if (fabs(a[r][c]) > fabs(a[pivot][c])) pivot = r;
        if (fabs(a[pivot][c]) < 1e-12) return false;
        for (int k = 0; k <= n; ++k) {
            double t = a[c][k];
            a[c][k] = a[pivot][k];
            a[pivot][k] = t;
        }
        for (int r = 0; r < n; ++r) {
            double f = r == c ? 0.0 : a[r][c] / a[c][c];
            for (int k = c; k <= n; ++k)
                a[r][k] -= f * a[c][k];
        }
    }
    for (int c = 0; c < n; ++c)
        a[c][n] /= a[c][c];
    return true;
}

static double square_distance(const cloud *c, int i, const double *p)
{
    double sum = 0.0;
    for (int k = 0; k < c->dimension; ++k)
        sum += (c->x[i][k] - p[k]) * (c->x[i][k] - p[k]);
    return sum;
}

/* Is no other point inside the sphere through these corners? False also for corners without a sphere. */
static bool is_delaunay(const cloud *c, const int *corner)
{
    int n = c->dimension;
    const double *o = c->x[corner[0]];
    double system[3][4], centre[3], radius = 0.0;
    for (int r = 0; r < n; ++r) {
        system[r][n] = 0.0;
        for (int k = 0; k < n; ++k) {
            double d = c->x[corner[r + 1]][k] - o[k];
            system[r][k] = 2.0 * d;
            system[r][n] += d * d;
        }
    }
    if (!solve(system, n)) return false;
    for (int k = 0; k < n; ++k) {
        centre[k] = o[k] + system[k][n];
        radius += system[k][n] * system[k][n];
    }
    for (int i = 0; i < c->count; ++i) {
        bool own = false;
        for (int k = 0; k <= n; ++k)
            own = own || corner[k] == i;
        if (!own && square_distance(c, i, centre) < radius) return false;
    }
    return true;
}

static double volume(const cloud *c, const int *corner)
{
    double e[3][3] = {{0}};
    for (int r = 0; r < c->dimension; ++r)
        for (int k = 0; k < c->dimension; ++k)
            e[r][k] = c->x[corner[r + 1]][k] - c->x[corner[0]][k];
    if (c->dimension == 1) return fabs(e[0][0]);
    if (c->dimension == 2) return fabs(e[0][0] * e[1][1] - e[0][1] * e[1][0]);
    return fabs(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]));
}

/* Flatter than SLIVER: volume against the square (in space) of the longest edge. */
static bool is_sliver(const cloud *c, const int *corner)
{
    double longest = 0.0, base = 1.0;
    for (int i = 0; i <= c->dimension; ++i)
        for (int k = 0; k < i; ++k)
            longest = ff_max(longest, square_distance(c, corner[i], c->x[corner[k]]));
    if (c->dimension == 2) base = sqrt(longest);
    if (c->dimension == 3) base = longest;
    return volume(c, corner) < SLIVER * base;
}

/* Axes of the span of the points, largest extent first; returns how many matter. */
static int span_axes(const ff_vec3 *points, int count, ff_vec3 axes[3])
{
    int dimension = 0;
    for (; dimension < 3; ++dimension) {
        ff_vec3 far = {0.0, 0.0, 0.0};
        for (int i = 1; i < count; ++i) {
            ff_vec3 d = ff_sub3(points[i], points[0]);
            for (int k = 0; k < dimension; ++k)
                d = ff_madd3(d, axes[k], -ff_dot3(d, axes[k]));
            if (ff_length3(d) > ff_length3(far)) far = d;
        }
        if (ff_length3(far) < FLAT) break;
        axes[dimension] = ff_unit3(far);
    }
    return dimension;
}

static void make_cloud(const ff_vec3 *points, int count, cloud *c)
{
    ff_vec3 axes[3];
    *c = (cloud){.count = 0};
    c->dimension = span_axes(points, count, axes);
    for (int i = 0; i < count; ++i) {
        bool seen = false;
        for (int k = 0; k < c->count; ++k)
            seen = seen || ff_length3(ff_sub3(points[i], points[c->id[k]])) < COINCIDE;
        if (seen) continue;
        ff_random random = {1, (uint64_t)i, 0};
        for (int k = 0; k < c->dimension; ++k)
            c->x[c->count][k] =
                ff_dot3(ff_sub3(points[i], points[0]), axes[k]) + ff_random_range(&random, -JITTER, JITTER);
        c->id[c->count++] = i;
    }
}

ff_status ff_simplices_find(const ff_vec3 *points, int count, ff_array *out, ff_error *error)
{
    if (count > FF_SIMPLICES_MAX_POINTS)
        return ff_fail(error, FF_ERR_RANGE, "%d examples to blend, at most %d", count,
                       FF_SIMPLICES_MAX_POINTS);
    if (count < 1) return FF_OK;
    cloud c;
    make_cloud(points, count, &c);
    int corner[4] = {0, 1, 2, 3}, size = c.dimension + 1;
    while (corner[size - 1] < c.count) {
        if (size == 1 || (!is_sliver(&c, corner) && is_delaunay(&c, corner))) {
            ff_simplex *simplex = ff_array_grow(out, 1, sizeof *simplex);
            if (!simplex) return ff_fail(error, FF_ERR_NO_MEMORY, "the simplices of %d examples", count);
            for (int k = 0; k < 4; ++k)
                simplex->vertex[k] = k < size ? c.id[corner[k]] : -1;
        }
        /* The next combination in lexical order. */
        int k = size - 1;
        ++corner[k];
        while (k > 0 && corner[k] > c.count - size + k)
            ++corner[--k];
        for (int j = k + 1; j < size; ++j)
            corner[j] = corner[j - 1] + 1;
        if (corner[0] > c.count - size) break;
    }
    return FF_OK;
}
