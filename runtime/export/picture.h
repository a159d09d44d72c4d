/* picture.h - drawing in colour, smooth-edged, to PNG. Coordinates and widths are pixels of the finished picture and
 * may be fractions; (0, 0) is the top left corner. Drawing outside the picture is cut off. */
#ifndef FF_PICTURE_H
#define FF_PICTURE_H

#include "runtime/footfall.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ff_picture ff_picture;
typedef struct ff_colour {
    uint8_t r, g, b;
} ff_colour;
typedef struct ff_pixel {
    double x, y;
} ff_pixel;
enum { FF_ALIGN_LEFT, FF_ALIGN_MIDDLE, FF_ALIGN_RIGHT };

/* Pictures are drawn this many times larger and reduced at the end. */
#define FF_PICTURE_SCALE 2

ff_status ff_picture_create(int width, int height, ff_colour background, ff_picture **out, ff_error *error);
void ff_picture_destroy(ff_picture *picture);

void ff_picture_line(ff_picture *picture, ff_pixel from, ff_pixel to, double width, ff_colour colour);
void ff_picture_lines(ff_picture *picture, const ff_pixel *points, int count, double width, ff_colour colour);
void ff_picture_polygon(ff_picture *picture, const ff_pixel *points, int count, ff_colour colour);
void ff_picture_disc(ff_picture *picture, ff_pixel centre, double radius, ff_colour colour);
void ff_picture_ring(ff_picture *picture, ff_pixel centre, double radius, double width, ff_colour colour);
void ff_picture_rectangle(ff_picture *picture, ff_pixel low, ff_pixel high, ff_colour colour);
/* place: where the text's base line starts, is centred or ends; height: of a capital letter. */
void ff_picture_text(ff_picture *picture, ff_pixel place, double height, int align, ff_colour colour,
                     const char *text);

/* Copy width x height RGB pixels, already FF_PICTURE_SCALE times larger, to (x, y). */
void ff_picture_paste(ff_picture *picture, int x, int y, const uint8_t *rgb, int width, int height);

/* The picture as the bytes of a PNG file; free(*bytes). */
ff_status ff_picture_encode_png(const ff_picture *picture, void **bytes, size_t *size, ff_error *error);
ff_status ff_picture_write_png(const ff_picture *picture, const char *path, ff_error *error);

/* Colour of a hue in turns (0 red, 1/3 green, 2/3 blue), saturation and brightness in [0, 1]. */
ff_colour ff_colour_hsv(double hue, double saturation, double value);

#ifdef __cplusplus
}
#endif
#endif
