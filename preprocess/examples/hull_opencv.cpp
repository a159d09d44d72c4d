// OpenCV's convex hull behind hull.h. Points go in as 32-bit floats, which is all that cv::convexHull takes beside
// integers; corners are then judged again in double, so that rounding neither adds nor loses one that matters.
#include "preprocess/examples/hull.h"

#include <opencv2/imgproc.hpp>

#include <cmath>
#include <vector>

namespace
{

double turn(ff_vec2 p, ff_vec2 q, ff_vec2 r)
{
    return (q.a - p.a) * (r.b - p.b) - (q.b - p.b) * (r.a - p.a);
}

bool before(ff_vec2 p, ff_vec2 q)
{
    return p.a < q.a || (p.a == q.a && p.b < q.b);
}

bool same(ff_vec2 p, ff_vec2 q)
{
    return std::fabs(p.a - q.a) < 1e-9 && std::fabs(p.b - q.b) < 1e-9;
}

/* Drop corners that lie on the line between their neighbours or on their predecessor. */
void drop_flat_corners(const ff_vec2 *points, std::vector<int> &corners)
{
    bool changed = true;
    while (changed && corners.size() > 1) {
        changed = false;
        for (size_t i = 0; i < corners.size() && corners.size() > 1; ++i) {
            size_t n = corners.size();
            ff_vec2 p = points[corners[(i + n - 1) % n]], q = points[corners[i]],
                    r = points[corners[(i + 1) % n]];
            bool on_edge = n > 2 && std::fabs(turn(p, q, r)) < 1e-9;
            if (!same(p, q) && !on_edge) continue;
            corners.erase(corners.begin() + static_cast<long>(i));
            changed = true;
            break;
        }
    }
}

} // namespace

int ff_hull_find(const ff_vec2 *points, int count, int *out)
try {
    if (count <= 0) return 0;
    std::vector<cv::Point2f> input;
    for (int i = 0; i < count; ++i)
        input.emplace_back(static_cast<float>(points[i].a), static_cast<float>(points[i].b));
    std::vector<int> corners;
    cv::convexHull(input, corners, false, false);
    double area = 0.0;
    for (size_t i = 0; i + 1 < corners.size(); ++i)
        area += turn(points[corners[0]], points[corners[i]], points[corners[i + 1]]);
    if (area < 0.0) corners.assign(corners.rbegin(), corners.rend());
    drop_flat_corners(points, corners);
    size_t first = 0;
    for (size_t i = 1; i < corners.size(); ++i)
        if (before(points[corners[i]], points[corners[first]])) first = i;
    for (size_t i = 0; i < corners.size(); ++i)
        out[i] = corners[(first + i) % corners.size()];
    return static_cast<int>(corners.size());
} catch (const std::exception &) {
    return -1;
}
