#include "runtime/export/body_shape.h"

#define APART                                                                                                \
    0.014 /* m, of a leg from the middle: more than its limbs swell where they flow into each other */

/* Sizes are those of a person with hips 0.95 m high and follow artists' proportions: head 1/7.5 of the height,
 * shoulders two heads wide. */

static void add(ff_body_shape *shape, uint32_t joint, ff_cover cover, ff_vec3 a, double radius_a, ff_vec3 b,
                double radius_b, double smooth)
{
    if (shape->count == FF_BODY_MAX_LIMBS) return;
    shape->limbs[shape->count++] = (ff_limb){.a = a,
                                             .b = b,
                                             .radius_a = radius_a * shape->scale,
                                             .radius_b = radius_b * shape->scale,
                                             .smooth = smooth * shape->scale,
                                             .joint = joint,
                                             .cover = cover};
}

/* p moved by (x, y, z) in units of the figure's scale. */
static ff_vec3 by(const ff_body_shape *shape, ff_vec3 p, double x, double y, double z)
{
    return ff_madd3(p, ff_v3(x, y, z), shape->scale);
}

static void add_trunk(ff_body_shape *shape, const ff_figure *figure)
{
    const ff_vec3 *rest = figure->rest;
    ff_vec3 shoulders = ff_lerp3(rest[FF_JOINT_SHOULDER_L], rest[FF_JOINT_SHOULDER_R], 0.5);
    ff_vec3 legs = ff_lerp3(rest[FF_JOINT_HIP_L], rest[FF_JOINT_HIP_R], 0.5);
    double length = (shoulders.y - legs.y) / shape->scale, z = legs.z;
    ff_vec3 base = ff_v3(0.0, legs.y, z);
    for (int side = -1; side <= 1; side += 2) {
        double x = side;
        ff_vec3 seat = by(shape, base, 0.062 * x, 0.02, -0.022),
                waist = by(shape, base, 0.047 * x, 0.20, 0.004);
        ff_vec3 ribs = by(shape, base, 0.070 * x, length - 0.13, -0.002);
        add(shape, FF_JOINT_HIPS, FF_COVER_TROUSERS, by(shape, seat, 0.0, 0.04, 0.025), 0.094,
            by(shape, seat, 0.008 * x, -0.05, -0.012), 0.088, 0.03);
        add(shape, FF_JOINT_HIPS, FF_COVER_TROUSERS, by(shape, base, 0.06 * x, 0.05, 0.0), 0.092,
            by(shape, base, 0.05 * x, 0.10, 0.004), 0.090, 0.03);
        add(shape, FF_JOINT_SPINE, FF_COVER_SHIRT, by(shape, base, 0.05 * x, 0.12, 0.004), 0.091, waist,
            0.087, 0.03);
        add(shape, FF_JOINT_CHEST, FF_COVER_SHIRT, waist, 0.087, ribs, 0.093, 0.04);
        add(shape, FF_JOINT_CHEST, FF_COVER_SHIRT, ribs, 0.093,
            by(shape, base, 0.085 * x, length - 0.045, -0.02), 0.072, 0.04);
    }
}

static void add_head(ff_body_shape *shape, const ff_figure *figure)
{
    ff_vec3 neck = figure->rest[FF_JOINT_NECK], head = figure->rest[FF_JOINT_HEAD];
    /* Some skeletons (CMU's) have their head joint in the middle of the head, ours is at the base of the skull. */
    head.y = ff_min(head.y, figure->rest[FF_JOINT_SHOULDER_L].y + 0.105 * shape->scale);
    add(shape, FF_JOINT_NECK, FF_COVER_SKIN, by(shape, neck, 0.0, 0.0, 0.0), 0.058,
        by(shape, head, 0.0, 0.02, 0.008), 0.053, 0.04);
    add(shape, FF_JOINT_HEAD, FF_COVER_HAIR, by(shape, head, 0.0, 0.125, 0.038), 0.079,
        by(shape, head, 0.0, 0.118, -0.012), 0.085, 0.02);
    add(shape, FF_JOINT_HEAD, FF_COVER_SKIN, by(shape, head, 0.0, 0.095, 0.050), 0.066,
        by(shape, head, 0.0, 0.025, 0.066), 0.042, 0.025);
    add(shape, FF_JOINT_HEAD, FF_COVER_SKIN, by(shape, head, 0.0, 0.095, 0.112), 0.010,
        by(shape, head, 0.0, 0.070, 0.124), 0.014, 0.015);
    for (int side = -1; side <= 1; side += 2)
        add(shape, FF_JOINT_HEAD, FF_COVER_SKIN, by(shape, head, 0.078 * side, 0.095, 0.018), 0.016,
            by(shape, head, 0.076 * side, 0.068, 0.024), 0.012, 0.01);
}

static void add_arm(ff_body_shape *shape, const ff_figure *figure, uint32_t clavicle, double x)
{
    const ff_vec3 *rest = figure->rest;
    ff_vec3 shoulder = rest[clavicle + 1], elbow = rest[clavicle + 2], wrist = rest[clavicle + 3];
    ff_vec3 sleeve = ff_lerp3(shoulder, elbow, 0.72);
    add(shape, clavicle, FF_COVER_SHIRT, by(shape, rest[FF_JOINT_NECK], 0.03 * x, -0.035, -0.012), 0.052,
        by(shape, shoulder, -0.02 * x, 0.0, 0.0), 0.052, 0.04);
    add(shape, clavicle + 1, FF_COVER_SHIRT, by(shape, shoulder, -0.005 * x, -0.008, 0.0), 0.061, sleeve,
        0.047, 0.04);
    add(shape, clavicle + 1, FF_COVER_SKIN, sleeve, 0.042, elbow, 0.039, 0.01);
    ff_vec3 belly = ff_lerp3(elbow, wrist, 0.28);
    add(shape, clavicle + 2, FF_COVER_SKIN, elbow, 0.039, belly, 0.041, 0.02);
    add(shape, clavicle + 2, FF_COVER_SKIN, belly, 0.041, wrist, 0.027, 0.02);
    ff_vec3 hand = by(shape, wrist, 0.075 * x, -0.003, 0.0);
    for (int edge = -1; edge <= 1; edge += 2) {
        ff_vec3 knuckle = by(shape, hand, 0.0, 0.0, 0.019 * edge);
        add(shape, clavicle + 3, FF_COVER_SKIN, by(shape, wrist, 0.01 * x, 0.0, 0.008 * edge), 0.023, knuckle,
            0.021, 0.02);
        add(shape, clavicle + 3, FF_COVER_SKIN, knuckle, 0.020,
            by(shape, hand, 0.072 * x, -0.02, 0.012 * edge), 0.013, 0.02);
    }
    add(shape, clavicle + 3, FF_COVER_SKIN, by(shape, wrist, 0.03 * x, -0.002, 0.02), 0.017,
        by(shape, wrist, 0.085 * x, -0.012, 0.055), 0.011, 0.015);
}

static void add_foot(ff_body_shape *shape, ff_vec3 ankle, ff_vec3 ball, uint32_t joint)
{
    /* The sole is cut at y = 0, so every part may reach a little below it. */
    double scale = shape->scale, low = 0.031;
    ff_vec3 heel = ff_v3(ankle.x, low * scale, ankle.z - 0.033 * scale);
    ff_vec3 middle = ff_lerp3(ankle, ball, 0.45);
    middle.y = 0.040 * scale;
    add(shape, joint, FF_COVER_SHOES, by(shape, ankle, 0.0, 0.0, -0.006), 0.041, heel, 0.033, 0.03);
    add(shape, joint, FF_COVER_SHOES, heel, 0.033, middle, 0.037, 0.02);
    add(shape, joint, FF_COVER_SHOES, by(shape, ankle, 0.0, -0.015, 0.008), 0.038,
        by(shape, ball, 0.0, 0.006, -0.025), 0.035, 0.03);
    for (int edge = -1; edge <= 1; edge += 2) {
        ff_vec3 side = ff_v3(ball.x + 0.015 * edge * scale, 0.028 * scale, ball.z);
        add(shape, joint, FF_COVER_SHOES, by(shape, middle, 0.004 * edge, 0.0, 0.0), 0.036, side, 0.032,
            0.02);
        add(shape, joint + 1, FF_COVER_SHOES, side, 0.032, by(shape, side, -0.006 * edge, -0.004, 0.052),
            0.025, 0.02);
    }
}

static void add_leg(ff_body_shape *shape, const ff_figure *figure, uint32_t joint, double x)
{
    ff_vec3 hip = figure->rest[joint], knee = figure->rest[joint + 1], ankle = figure->rest[joint + 2];
    ff_vec3 thigh = ff_lerp3(hip, knee, 0.30), cuff = ff_lerp3(knee, ankle, 0.90);
    ff_vec3 calf = by(shape, ff_lerp3(knee, ankle, 0.30), 0.0, 0.0, -0.014);
    add(shape, joint, FF_COVER_TROUSERS, by(shape, hip, 0.004 * x, -0.005, 0.0), 0.086,
        by(shape, thigh, 0.004 * x, 0.0, 0.004), 0.082, 0.025);
    add(shape, joint, FF_COVER_TROUSERS, by(shape, thigh, 0.004 * x, 0.0, 0.004), 0.082, knee, 0.058, 0.02);
    add(shape, joint + 1, FF_COVER_TROUSERS, knee, 0.057, calf, 0.057, 0.02);
    add(shape, joint + 1, FF_COVER_TROUSERS, calf, 0.057, cuff, 0.047, 0.02);
    add(shape, joint + 1, FF_COVER_SKIN, cuff, 0.036, ankle, 0.036, 0.005);
    add_foot(shape, ankle, figure->rest[joint + 3], joint + 2);
}

void ff_body_shape_make(const ff_figure *figure, ff_body_shape *out)
{
    out->count = 0;
    out->scale = ff_figure_scale(figure);
    add_trunk(out, figure);
    add_head(out, figure);
    add_arm(out, figure, FF_JOINT_CLAVICLE_L, 1.0);
    add_arm(out, figure, FF_JOINT_CLAVICLE_R, -1.0);
    add_leg(out, figure, FF_JOINT_HIP_L, 1.0);
    add_leg(out, figure, FF_JOINT_HIP_R, -1.0);
}

/* Legs flow into the trunk, not into each other, however near they are in the rest pose: skin between them would stretch like a
 * skirt as they walk. */
static bool is_leg(const ff_limb *limb)
{
    return limb->joint >= FF_JOINT_HIP_L;
}

double ff_limb_distance(const ff_body_shape *shape, const ff_limb *limb, ff_vec3 point)
{
    ff_vec3 axis = ff_sub3(limb->b, limb->a), from = ff_sub3(point, limb->a);
    double squared = ff_dot3(axis, axis);
    double t = squared > 1e-12 ? ff_clamp(ff_dot3(from, axis) / squared, 0.0, 1.0) : 0.0;
    double d = ff_length3(ff_madd3(from, axis, -t)) - ff_lerp(limb->radius_a, limb->radius_b, t);
    double x = limb->joint >= FF_JOINT_HIP_R ? -point.x : point.x;
    return is_leg(limb) ? ff_max(d, APART * shape->scale - x) : d;
}

double ff_body_distance(const ff_body_shape *shape, ff_vec3 point)
{
    double half[2] = {1e9, 1e9}; /* with the left leg, with the right one */
    for (uint32_t i = 0; i < shape->count; ++i) {
        const ff_limb *limb = &shape->limbs[i];
        double d = ff_limb_distance(shape, limb, point), k = limb->smooth;
        for (int side = 0; side < 2; ++side) {
            if (is_leg(limb) && (limb->joint >= FF_JOINT_HIP_R) != (side == 1)) continue;
            /* Quadratic smooth minimum: exact away from where both are near. */
            double h = k > 0.0 ? ff_max(k - fabs(d - half[side]), 0.0) / k : 0.0;
            half[side] = ff_min(half[side], d) - 0.25 * h * h * k;
        }
    }
    return ff_max(ff_min(half[0], half[1]), -point.y);
}
