#include "mocap/generator/curves.h"

/* Does this person have the band? Returns the set or NULL. */
static const ff_person_gait *person_set(int person, ff_band band)
{
    for (int i = 0; i < FF_PERSON_SETS; ++i)
        if (ff_people_gait[i].person == person && ff_people_gait[i].band == band) return &ff_people_gait[i];
    return NULL;
}

/* A person's curve in a band. A band the person was not measured in is the mean one plus how the person differs from
 * the mean in the nearest band there is. */
static ff_fourier band_curve(int person, ff_band band, ff_curve curve)
{
    ff_fourier mean = ff_mean_gait[band][curve];
    if (person == 0 || curve >= FF_CURVE_PERSONAL_COUNT) return mean;
    for (int away = 0; away < FF_BAND_COUNT; ++away) {
        for (int side = -1; side <= 1; side += 2) {
            int other = (int)band + side * away;
            if (other < 0 || other >= FF_BAND_COUNT) continue;
            const ff_person_gait *set = person_set(person, (ff_band)other);
            if (!set) continue;
            for (int k = 0; k < 13; ++k)
                mean.c[k] += set->curves[curve].c[k] - ff_mean_gait[other][curve].c[k];
            return mean;
        }
    }
    return mean;
}

static bool is_length(ff_curve curve)
{
    return curve == FF_CURVE_PELVIS_X || curve == FF_CURVE_PELVIS_Y || curve == FF_CURVE_PELVIS_Z ||
           curve == FF_CURVE_ANKLE_Y || curve == FF_CURVE_ANKLE_Z;
}

/* Means that only say how each measured skeleton was calibrated (gait facts, Limits): taken out. */
static bool is_calibration(ff_curve curve)
{
    return curve == FF_CURVE_PELVIS_PITCH_FWD || curve == FF_CURVE_HEAD_PITCH_FWD;
}

/* Averaging over people whose peaks fall at different times blurs the mean walker's trunk: range of single strides over
 * range of the mean curve (fourier.csv, range_mean_of_strides / range_of_mean, rounded down). */
static double unblurred(int person, ff_curve curve)
{
    if (person != 0) return 1.0;
    switch (curve) {
    case FF_CURVE_PELVIS_YAW:
    case FF_CURVE_PELVIS_ROLL:
    case FF_CURVE_PELVIS_PITCH_FWD:
        return 1.1;
    case FF_CURVE_THORAX_YAW:
    case FF_CURVE_THORAX_PITCH_FWD:
    case FF_CURVE_THORAX_ROLL:
        return 1.25;
    case FF_CURVE_HEAD_YAW:
    case FF_CURVE_HEAD_PITCH_FWD:
    case FF_CURVE_HEAD_ROLL:
        return 1.6;
    default:
        return 1.0;
    }
}

void ff_gait_set_at(int person, double speed, bool run, ff_gait_set *out)
{
    ff_band low = FF_BAND_RUN, high = FF_BAND_RUN;
    double t = 0.0, size = 1.0;
    if (run) {
        size = ff_clamp(0.6 + 0.4 * speed / ff_band_speed[FF_BAND_RUN], 0.7, 1.15);
    } else {
        low = speed < ff_band_speed[FF_BAND_NORMAL] ? FF_BAND_SLOW : FF_BAND_NORMAL;
        high = (ff_band)(low + 1);
        t = ff_clamp((speed - ff_band_speed[low]) / (ff_band_speed[high] - ff_band_speed[low]), 0.0, 1.3);
        size = ff_clamp(speed / ff_band_speed[FF_BAND_SLOW], 0.0, 1.0);
        size *= 1.5 - 0.5 * size; /* small steps are not quite so small in the trunk as in length */
    }
    for (int c = 0; c < FF_CURVE_COUNT; ++c) {
        ff_fourier a = band_curve(person, low, (ff_curve)c), b = band_curve(person, high, (ff_curve)c);
        double unit = is_length((ff_curve)c) ? 1.0 : FF_DEG, swing = size * unblurred(person, (ff_curve)c);
        for (int k = 0; k < 13; ++k)
            out->curve[c].c[k] = ff_lerp(a.c[k], b.c[k], t) * unit * (k == 0 ? 1.0 : swing);
        if (is_calibration((ff_curve)c)) out->curve[c].c[0] = 2.0 * FF_DEG;
    }
}

double ff_fourier_slope(const ff_fourier *curve, double phase, double *slope)
{
    double s1, c1, s = 0.0, c = 1.0, value = curve->c[0], rise = 0.0;
    ff_sincos(FF_TAU * (phase - floor(phase)), &s1, &c1);
    for (int k = 1; k <= 6; ++k) {
        double next = c * c1 - s * s1; /* angle addition: cos and sin of k times the angle */
        s = s * c1 + c * s1;
        c = next;
        double a = curve->c[2 * k - 1], b = curve->c[2 * k];
        value += a * c + b * s;
        rise += FF_TAU * k * (b * c - a * s);
    }
    *slope = rise;
    return value;
}

double ff_fourier_at(const ff_fourier *curve, double phase)
{
    double slope;
    return ff_fourier_slope(curve, phase, &slope);
}

/* v^power without libm. */
static double raised(double v, double power)
{
    /* ln v by Newton's method on exp: v lies between 0.1 and 10 here */
    double ln = 0.0;
    for (int i = 0; i < 30; ++i)
        ln += 2.0 * (v - ff_exp(ln)) / (v + ff_exp(ln));
    return ff_exp(power * ln);
}

/* The fits over all CMU clips: gait facts, "Straight walking and running". */
double ff_usual_stance(double speed, bool run)
{
    return run ? 0.3948 - 0.0129 * speed : ff_clamp(0.7102 - 0.0749 * speed, 0.56, 0.68);
}
double ff_usual_step_rate(double speed, bool run)
{
    speed = ff_clamp(speed, 0.1, 6.0);
    return run ? 110.2943 / 60.0 * raised(speed, 0.3398) : 98.2308 / 60.0 * raised(speed, 0.4783);
}
double ff_usual_width(double speed, bool run)
{
    return run ? ff_max(0.0, -0.0548 + 0.0182 * speed) : ff_clamp(0.1687 - 0.0792 * speed, 0.04, 0.14);
}
