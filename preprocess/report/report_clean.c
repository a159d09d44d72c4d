#include "preprocess/report/report_parts.h"

/* Number i of a pair [before, after], or the number itself. */
static double number(const json_t *clean, const char *name, size_t i)
{
    const json_t *value = json_object_get(clean, name);
    return json_number_value(json_is_array(value) ? json_array_get(value, i) : value);
}

void ff_report_clean(ff_text *page, const json_t *clean)
{
    if (!clean) return;
    if (json_is_true(json_object_get(clean, "was_clean"))) {
        ff_text_add(page,
                    "<p class=\"key\">Planted feet stand still as they are: nothing was cleaned up.</p>\n");
        return;
    }
    ff_text_add(page,
                "<table class=\"key\"><tr><th>cleaning up the feet<th>before<th>after\n"
                "<tr><td>ball of a flat foot from its pin: median, worst<td>%.1f, %.1f mm<td>%.2f, %.2f mm\n"
                "<tr><td>its speed<td>%.0f mm/s<td>%.1f mm/s\n"
                "<tr><td>deepest sole under the floor<td>%.1f mm<td>%.1f mm\n"
                "<tr><td>straightest knee<td>%.1f&deg;<td>%.1f&deg;\n",
                number(clean, "pin_median_mm", 0), number(clean, "pin_worst_mm", 0),
                number(clean, "pin_median_mm", 1), number(clean, "pin_worst_mm", 1),
                number(clean, "skate_mm_per_s", 0), number(clean, "skate_mm_per_s", 1),
                number(clean, "floor_dip_mm", 0), number(clean, "floor_dip_mm", 1),
                number(clean, "knee_least_deg", 0), number(clean, "knee_least_deg", 1));
    const char *joint = json_string_value(json_object_get(clean, "turned_most_joint"));
    ff_text_add(
        page,
        "<tr><td colspan=3>hips and legs turned by %.2f&deg; on average, 95 %% by less than %.1f&deg;, most "
        "%.1f&deg; (%s, frame %.0f)",
        number(clean, "turned_mean_deg", 0), number(clean, "turned_95_deg", 0),
        number(clean, "turned_most_deg", 0), joint ? joint : "?", number(clean, "turned_most_frame", 0));
    ff_text_add(
        page,
        "; hips moved by %.1f mm, at most %.1f; accelerations of knees and ankles %.2f times the captured "
        "ones; left over by the solver %.2f mm</table>\n",
        number(clean, "hips_moved_mean_mm", 0), number(clean, "hips_moved_most_mm", 0),
        number(clean, "acceleration_ratio", 0), number(clean, "residual_mm", 0));
}
