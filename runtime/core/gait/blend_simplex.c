#include "runtime/core/gait/blend_simplex.h"

ff_vec3 ff_blend_point(ff_rates rates)
{
    return ff_v3(rates.forward, rates.left, rates.turn * FF_BLEND_TURN_SCALE);
}

ff_rates ff_blend_rates(ff_vec3 point)
{
    return (ff_rates){point.x, point.y, point.z / FF_BLEND_TURN_SCALE};
}

bool ff_blend_solid_make(const ff_vec3 corner[4], const int32_t vertex[4], ff_blend_solid *out)
{
    ff_vec3 u = ff_sub3(corner[0], corner[3]);
    ff_vec3 v = ff_sub3(corner[1], corner[3]);
    ff_vec3 w = ff_sub3(corner[2], corner[3]);
    ff_vec3 vw = ff_cross3(v, w);
    double volume = ff_dot3(u, vw);
    if (!(fabs(volume) >= 6e-6)) return false; /* algorithms D.2: volume 1e-6 */
    out->origin = corner[3];
    out->inverse[0] = ff_scale3(vw, 1.0 / volume);
    out->inverse[1] = ff_scale3(ff_cross3(w, u), 1.0 / volume);
    out->inverse[2] = ff_scale3(ff_cross3(u, v), 1.0 / volume);
    out->low = out->high = corner[0];
    for (int i = 0; i < 4; ++i) {
        out->vertex[i] = vertex[i];
        out->low = ff_v3(ff_min(out->low.x, corner[i].x), ff_min(out->low.y, corner[i].y),
                         ff_min(out->low.z, corner[i].z));
        out->high = ff_v3(ff_max(out->high.x, corner[i].x), ff_max(out->high.y, corner[i].y),
                          ff_max(out->high.z, corner[i].z));
    }
    return true;
}

bool ff_blend_solid_locate(const ff_blend_solid *solid, ff_vec3 p, double tolerance, double weight[4])
{
    ff_vec3 d = ff_sub3(p, solid->origin);
    weight[3] = 1.0;
    for (int i = 0; i < 3; ++i) {
        weight[i] = ff_dot3(solid->inverse[i], d);
        weight[3] -= weight[i];
    }
    for (int i = 0; i < 4; ++i)
        if (!(weight[i] >= -tolerance)) return false;
    return true;
}

static double distance_squared(ff_vec3 p, ff_vec3 q)
{
    ff_vec3 d = ff_sub3(p, q);
    return ff_dot3(d, d);
}

static double segment_nearest(ff_vec3 a, ff_vec3 b, ff_vec3 p, double *share)
{
    ff_vec3 ab = ff_sub3(b, a);
    double length = ff_dot3(ab, ab);
    *share = length > 1e-18 ? ff_clamp(ff_dot3(ff_sub3(p, a), ab) / length, 0.0, 1.0) : 0.0;
    return distance_squared(ff_madd3(a, ab, *share), p);
}

static void set3(double weight[3], double a, double b, double c)
{
    weight[0] = a;
    weight[1] = b;
    weight[2] = c;
}

/* On the border of the triangle: the best of its three sides. */
static double border_nearest(const ff_vec3 corner[3], ff_vec3 p, double weight[3])
{
    double best = -1.0;
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3;
        double share, distance = segment_nearest(corner[i], corner[j], p, &share);
        if (best >= 0.0 && distance >= best) continue;
        best = distance;
        set3(weight, 0.0, 0.0, 0.0);
        weight[i] = 1.0 - share;
        weight[j] = share;
    }
    return best;
}

/* Inside the triangle when the projection's barycentric coordinates are all positive (Ericson, Real-Time Collision
 * Detection, 3.4), else on its border. */
static double triangle_nearest(const ff_vec3 corner[3], ff_vec3 p, double weight[3])
{
    ff_vec3 u = ff_sub3(corner[1], corner[0]), v = ff_sub3(corner[2], corner[0]), d = ff_sub3(p, corner[0]);
    double uu = ff_dot3(u, u), uv = ff_dot3(u, v), vv = ff_dot3(v, v);
    double du = ff_dot3(d, u), dv = ff_dot3(d, v);
    double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12)) return border_nearest(corner, p, weight);
    double b = (vv * du - uv * dv) / determinant, c = (uu * dv - uv * du) / determinant;
    if (b < 0.0 || c < 0.0 || b + c > 1.0) return border_nearest(corner, p, weight);
    set3(weight, 1.0 - b - c, b, c);
    return distance_squared(ff_madd3(ff_madd3(corner[0], u, b), v, c), p);
}

double ff_blend_face_nearest(const ff_vec3 *corner, int count, ff_vec3 p, double weight[3])
{
    set3(weight, 1.0, 0.0, 0.0);
    if (count == 1) return distance_squared(corner[0], p);
    if (count == 3) return triangle_nearest(corner, p, weight);
    double distance = segment_nearest(corner[0], corner[1], p, &weight[1]);
    weight[0] = 1.0 - weight[1];
    return distance;
}
