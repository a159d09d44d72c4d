// picture_opencv.cpp - the pictures of picture.h on OpenCV's drawing functions.
#include "runtime/export/picture.h"

extern "C" {
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
}

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

struct ff_picture {
    cv::Mat large;
};

namespace
{
constexpr int shift = 4; // sub-pixel bits of OpenCV's fixed-point coordinates
constexpr double scale = FF_PICTURE_SCALE;

cv::Scalar bgr(ff_colour colour)
{
    return cv::Scalar(colour.b, colour.g, colour.r);
}

// OpenCV draws in 32 bits: keep far away points where it can cope.
int fixed(double value)
{
    return static_cast<int>(std::lround(std::clamp(value * scale, -1e5, 1e5) * (1 << shift)));
}

cv::Point at(ff_pixel p)
{
    return cv::Point(fixed(p.x), fixed(p.y));
}

int thickness(double width)
{
    return std::max(1, static_cast<int>(std::lround(width * scale)));
}

// Nothing OpenCV throws may pass into C; a shape it refuses is left out of the picture.
template <typename Draw>
void guarded(Draw draw) noexcept
{
    try {
        draw();
    } catch (...) {
    }
}
} // namespace

extern "C" {

ff_status ff_picture_create(int width, int height, ff_colour background, ff_picture **out, ff_error *error)
{
    *out = nullptr;
    if (width < 1 || height < 1 || width > 20000 || height > 20000)
        return ff_fail(error, FF_ERR_RANGE, "a picture of %d x %d pixels", width, height);
    try {
        *out = new ff_picture{
            cv::Mat(height * FF_PICTURE_SCALE, width * FF_PICTURE_SCALE, CV_8UC3, bgr(background))};
        return FF_OK;
    } catch (...) {
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a picture of %d x %d pixels", width, height);
    }
}

void ff_picture_destroy(ff_picture *picture)
{
    delete picture;
}

void ff_picture_line(ff_picture *picture, ff_pixel from, ff_pixel to, double width, ff_colour colour)
{
    guarded([&] {
        cv::line(picture->large, at(from), at(to), bgr(colour), thickness(width), cv::LINE_AA, shift);
    });
}

void ff_picture_lines(ff_picture *picture, const ff_pixel *points, int count, double width, ff_colour colour)
{
    guarded([&] {
        std::vector<cv::Point> chain;
        std::transform(points, points + count, std::back_inserter(chain), at);
        cv::polylines(picture->large, chain, false, bgr(colour), thickness(width), cv::LINE_AA, shift);
    });
}

void ff_picture_polygon(ff_picture *picture, const ff_pixel *points, int count, ff_colour colour)
{
    guarded([&] {
        std::vector<cv::Point> ring;
        std::transform(points, points + count, std::back_inserter(ring), at);
        cv::fillPoly(picture->large, ring, bgr(colour), cv::LINE_AA, shift);
    });
}

void ff_picture_disc(ff_picture *picture, ff_pixel centre, double radius, ff_colour colour)
{
    guarded([&] {
        cv::circle(picture->large, at(centre), fixed(radius), bgr(colour), cv::FILLED, cv::LINE_AA, shift);
    });
}

void ff_picture_ring(ff_picture *picture, ff_pixel centre, double radius, double width, ff_colour colour)
{
    guarded([&] {
        cv::circle(picture->large, at(centre), fixed(radius), bgr(colour), thickness(width), cv::LINE_AA,
                   shift);
    });
}

void ff_picture_rectangle(ff_picture *picture, ff_pixel low, ff_pixel high, ff_colour colour)
{
    const ff_pixel ring[4] = {low, {high.x, low.y}, high, {low.x, high.y}};
    ff_picture_polygon(picture, ring, 4, colour);
}

void ff_picture_text(ff_picture *picture, ff_pixel place, double height, int align, ff_colour colour,
                     const char *text)
{
    guarded([&] {
        const int face = cv::FONT_HERSHEY_DUPLEX; // capitals are 22 units high
        const double size = height * scale / 22.0;
        const int width = std::max(1, static_cast<int>(std::lround(size * 1.4)));
        int base = 0;
        const cv::Size extent = cv::getTextSize(text, face, size, width, &base);
        const double left = place.x * scale - (align == FF_ALIGN_LEFT ? 0.0 : extent.width) *
                                                  (align == FF_ALIGN_MIDDLE ? 0.5 : 1.0);
        const cv::Point start(static_cast<int>(std::lround(left)),
                              static_cast<int>(std::lround(place.y * scale)));
        cv::putText(picture->large, text, start, face, size, bgr(colour), width, cv::LINE_AA);
    });
}

void ff_picture_paste(ff_picture *picture, int x, int y, const uint8_t *rgb, int width, int height)
{
    guarded([&] {
        const cv::Mat source(height, width, CV_8UC3, const_cast<uint8_t *>(rgb));
        const cv::Rect whole(0, 0, picture->large.cols, picture->large.rows);
        const cv::Rect wanted(x * FF_PICTURE_SCALE, y * FF_PICTURE_SCALE, width, height);
        const cv::Rect seen = wanted & whole;
        if (seen.area() == 0) return;
        cv::cvtColor(source(seen - wanted.tl()), picture->large(seen), cv::COLOR_RGB2BGR);
    });
}

ff_status ff_picture_encode_png(const ff_picture *picture, void **bytes, size_t *size, ff_error *error)
{
    *bytes = nullptr;
    *size = 0;
    try {
        cv::Mat small;
        cv::resize(picture->large, small, cv::Size(), 1.0 / scale, 1.0 / scale, cv::INTER_AREA);
        std::vector<unsigned char> encoded;
        if (!cv::imencode(".png", small, encoded, {cv::IMWRITE_PNG_COMPRESSION, 6}))
            return ff_fail(error, FF_ERR_IO, "the picture could not be encoded as PNG");
        *bytes = std::malloc(encoded.size());
        if (*bytes == nullptr) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a picture");
        std::memcpy(*bytes, encoded.data(), encoded.size());
        *size = encoded.size();
        return FF_OK;
    } catch (...) {
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a picture");
    }
}

ff_status ff_picture_write_png(const ff_picture *picture, const char *path, ff_error *error)
{
    void *bytes;
    size_t size;
    ff_status status = ff_picture_encode_png(picture, &bytes, &size, error);
    if (status == FF_OK) status = ff_file_write_atomic(path, bytes, size, error);
    std::free(bytes);
    return status;
}

ff_colour ff_colour_hsv(double hue, double saturation, double value)
{
    const double turn = (hue - std::floor(hue)) * 6.0;
    auto channel = [&](double offset) {
        const double k = std::fmod(offset + turn, 6.0);
        const double part = std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
        return static_cast<uint8_t>(std::lround(255.0 * value * (1.0 - saturation * part)));
    };
    return ff_colour{channel(5.0), channel(3.0), channel(1.0)};
}
}
