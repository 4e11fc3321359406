/* Filters by OpenCV, which the registration needs already. */
#include "compare/pictures/picture_quality.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <vector>

namespace
{

using cv::Mat;
using cv::Vec3d;

Mat mat_of(const weft_image *image)
{
    Mat copy;
    Mat(image->height, image->width, CV_32FC3, image->pixels).convertTo(copy, CV_64F);
    return copy;
}

/* The maps of all measures have one number a pixel. */
Mat map_like(const Mat &picture)
{
    return Mat(picture.rows, picture.cols, CV_64F);
}

/* Of the three channels. */
Mat mean_squares(const Mat &reference, const Mat &test)
{
    Mat map = map_like(reference);
    map.forEach<double>([&](double &square, const int *at) {
        Vec3d apart = reference.at<Vec3d>(at[0], at[1]) - test.at<Vec3d>(at[0], at[1]);
        square = apart.dot(apart) / 3;
    });
    return map;
}

/* ---- SSIM ---- */

Mat local_mean(const Mat &values)
{
    constexpr int side = 11;
    constexpr double deviation = 1.5;
    Mat mean;
    cv::GaussianBlur(values, mean, cv::Size(side, side), deviation, deviation, cv::BORDER_REFLECT);
    return mean;
}

Mat ssim_map(const Mat &x, const Mat &y)
{
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    Mat mx = local_mean(x), my = local_mean(y);
    Mat xx = local_mean(x.mul(x)) - mx.mul(mx), yy = local_mean(y.mul(y)) - my.mul(my),
        xy = local_mean(x.mul(y)) - mx.mul(my);
    Mat map = Mat::zeros(x.rows, x.cols, CV_64F);
    for (int row = 0; row < x.rows; row++) {
        for (int i = 0; i < 3 * x.cols; i++) {
            double a = mx.ptr<double>(row)[i], b = my.ptr<double>(row)[i];
            double covariance = xy.ptr<double>(row)[i], variances = xx.ptr<double>(row)[i] + yy.ptr<double>(row)[i];
            map.at<double>(row, i / 3) +=
                (2 * a * b + c1) * (2 * covariance + c2) / ((a * a + b * b + c1) * (variances + c2)) / 3;
        }
    }
    return map;
}

/* ---- FLIP: colours ---- */

const cv::Matx33d xyz_of_rgb(10135552 / 24577794., 8788810 / 24577794., 4435075 / 24577794., 2613072 / 12288897.,
                             8788810 / 12288897., 887015 / 12288897., 1425312 / 73733382., 8788810 / 73733382.,
                             70074185 / 73733382.);
const Vec3d white = xyz_of_rgb * Vec3d(1, 1, 1);

double linear_of_srgb(double encoded)
{
    return encoded > 0.04045 ? std::pow((encoded + 0.055) / 1.055, 2.4) : encoded / 12.92;
}

/* Opponent colours that are linear in light: luminance, red against green, blue against yellow. */
Vec3d opponent_of_srgb(const Vec3d &encoded)
{
    Vec3d linear(linear_of_srgb(encoded[0]), linear_of_srgb(encoded[1]), linear_of_srgb(encoded[2]));
    Vec3d n = xyz_of_rgb * linear;
    cv::divide(n, white, n);
    return Vec3d(116 * n[1] - 16, 500 * (n[0] - n[1]), 200 * (n[1] - n[2]));
}

double lab_root(double t)
{
    constexpr double delta = 6 / 29.;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4 / 29.;
}

/* CIELAB whose colours fade with darkness, as Hunt found that they do. */
Vec3d hunt_lab_of_linear(const Vec3d &linear)
{
    Vec3d n = xyz_of_rgb * linear;
    cv::divide(n, white, n);
    double x = lab_root(n[0]), y = lab_root(n[1]), z = lab_root(n[2]), lightness = 116 * y - 16;
    return Vec3d(lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z));
}

Vec3d hunt_lab_of_opponent(const Vec3d &opponent)
{
    double y = (opponent[0] + 16) / 116;
    Vec3d xyz((y + opponent[1] / 500) * white[0], y * white[1], (y - opponent[2] / 200) * white[2]);
    Vec3d linear = xyz_of_rgb.inv() * xyz;
    for (int c = 0; c < 3; c++)
        linear[c] = std::clamp(linear[c], 0.0, 1.0);
    return hunt_lab_of_linear(linear);
}

double hyab(const Vec3d &a, const Vec3d &b)
{
    return std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

constexpr double colour_exponent = 0.7, feature_exponent = 0.5;

/* 0..1: small differences have most of the scale. */
double colour_difference(const Vec3d &a, const Vec3d &b)
{
    constexpr double knee = 0.4, at_knee = 0.95;
    const double most =
        std::pow(hyab(hunt_lab_of_linear(Vec3d(0, 1, 0)), hunt_lab_of_linear(Vec3d(0, 0, 1))), colour_exponent);
    double difference = std::pow(hyab(a, b), colour_exponent);
    if (difference < knee * most)
        return at_knee / (knee * most) * difference;
    return at_knee + (difference - knee * most) / (most - knee * most) * (1 - at_knee);
}

/* ---- FLIP: filters ---- */

/* a1 sqrt(pi / b1) exp(-pi^2 d^2 / b1) + the same of a2 and b2, d in degrees: what the eye resolves. */
Mat sensitivity_filter(double a1, double b1, double a2, double b2)
{
    constexpr double widest = 0.04;
    int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * CV_PI * CV_PI)) * weft_pixels_per_degree));
    Mat filter(2 * radius + 1, 2 * radius + 1, CV_64F);
    for (int y = -radius; y <= radius; y++) {
        for (int x = -radius; x <= radius; x++) {
            double square = (x * x + y * y) / (weft_pixels_per_degree * weft_pixels_per_degree);
            filter.at<double>(y + radius, x + radius) =
                a1 * std::sqrt(CV_PI / b1) * std::exp(-CV_PI * CV_PI * square / b1) +
                a2 * std::sqrt(CV_PI / b2) * std::exp(-CV_PI * CV_PI * square / b2);
        }
    }
    return filter / cv::sum(filter)[0];
}

/* First (edges) or second (points) derivatives of a Gaussian along x; what is positive sums to 1, what is negative to
 * -1. */
Mat feature_filter(bool points)
{
    constexpr double feature_degrees = 0.082;
    double deviation = 0.5 * feature_degrees * weft_pixels_per_degree, positive = 0, negative = 0;
    int radius = static_cast<int>(std::ceil(3 * deviation));
    Mat filter(2 * radius + 1, 2 * radius + 1, CV_64F);
    for (int y = -radius; y <= radius; y++) {
        for (int x = -radius; x <= radius; x++) {
            double gaussian = std::exp(-(x * x + y * y) / (2 * deviation * deviation));
            double weight = (points ? x * x / (deviation * deviation) - 1 : -x) * gaussian;
            filter.at<double>(y + radius, x + radius) = weight;
            (weight > 0 ? positive : negative) += std::fabs(weight);
        }
    }
    filter.forEach<double>([&](double &weight, const int *) { weight /= weight > 0 ? positive : negative; });
    return filter;
}

Mat filtered(const Mat &values, const Mat &filter)
{
    Mat result;
    cv::filter2D(values, result, -1, filter, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
    return result;
}

Mat length_of_gradient(const Mat &luminance, bool points)
{
    Mat along_x = feature_filter(points), length;
    cv::magnitude(filtered(luminance, along_x), filtered(luminance, along_x.t()), length);
    return length;
}

/* ---- FLIP ---- */

struct seen_picture {
    Mat colour; /* as the eye resolves it */
    Mat edges, points;
};

seen_picture seen(const Mat &encoded)
{
    Mat opponent = encoded.clone(), channel[3];
    opponent.forEach<Vec3d>([](Vec3d &pixel, const int *) { pixel = opponent_of_srgb(pixel); });
    cv::split(opponent, channel);
    Mat luminance = (channel[0] + 16) / 116;
    channel[0] = filtered(channel[0], sensitivity_filter(1, 0.0047, 0, 1e-5));
    channel[1] = filtered(channel[1], sensitivity_filter(1, 0.0053, 0, 1e-5));
    channel[2] = filtered(channel[2], sensitivity_filter(34.1, 0.04, 13.5, 0.025));
    seen_picture result{Mat(), length_of_gradient(luminance, false), length_of_gradient(luminance, true)};
    cv::merge(channel, 3, result.colour);
    result.colour.forEach<Vec3d>([](Vec3d &pixel, const int *) { pixel = hunt_lab_of_opponent(pixel); });
    return result;
}

Mat flip_map(const Mat &reference, const Mat &test)
{
    seen_picture a = seen(reference), b = seen(test);
    Mat map = map_like(reference);
    for (int y = 0; y < reference.rows; y++) {
        for (int x = 0; x < reference.cols; x++) {
            double colour = colour_difference(a.colour.at<Vec3d>(y, x), b.colour.at<Vec3d>(y, x));
            double feature = std::max(std::fabs(a.edges.at<double>(y, x) - b.edges.at<double>(y, x)),
                                      std::fabs(a.points.at<double>(y, x) - b.points.at<double>(y, x)));
            map.at<double>(y, x) = std::pow(colour, 1 - std::pow(feature / std::sqrt(2.0), feature_exponent));
        }
    }
    return map;
}

/* ---- Regions ---- */

struct quality_maps {
    Mat squares, ssim, flip;
};

weft_picture_quality quality_of(const quality_maps &maps, const Mat &regions, int bit, long *pixels)
{
    double squares = 0, ssim = 0, flip = 0;
    long count = 0;
    for (int y = 0; y < regions.rows; y++) {
        for (int x = 0; x < regions.cols; x++) {
            if (!(regions.at<uint8_t>(y, x) >> bit & 1))
                continue;
            squares += maps.squares.at<double>(y, x);
            ssim += maps.ssim.at<double>(y, x);
            flip += maps.flip.at<double>(y, x);
            count++;
        }
    }
    *pixels = count;
    if (count == 0)
        return weft_picture_quality{0, 0, 0};
    auto of = static_cast<double>(count);
    double psnr_db = squares > 0 ? -10 * std::log10(squares / of) : std::numeric_limits<double>::infinity();
    return weft_picture_quality{psnr_db, ssim / of, flip / of};
}

} // namespace

extern "C" weft_code weft_picture_quality_by_region(const weft_image *reference, const weft_image *test,
                                                    const uint8_t *regions, int region_count,
                                                    weft_picture_quality *result, long *pixels, weft_error *error)
{
    if (reference->width != test->width || reference->height != test->height)
        return weft_fail(error, WEFT_BAD_USAGE, "pictures of %d x %d and %d x %d cannot be compared", reference->width,
                         reference->height, test->width, test->height);
    try {
        Mat a = mat_of(reference), b = mat_of(test),
            marked(reference->height, reference->width, CV_8U, const_cast<uint8_t *>(regions));
        quality_maps maps{mean_squares(a, b), ssim_map(a, b), flip_map(a, b)};
        for (int k = 0; k < region_count; k++)
            result[k] = quality_of(maps, marked, k, &pixels[k]);
        return WEFT_OK;
    } catch (const std::bad_alloc &) {
        return weft_fail_memory(error, "pictures", 0);
    } catch (const std::exception &failure) {
        return weft_fail(error, WEFT_SYSTEM, "comparing pictures failed: %s", failure.what());
    } catch (...) {
        return weft_fail(error, WEFT_SYSTEM, "comparing pictures failed");
    }
}

extern "C" weft_code weft_picture_quality_measure(const weft_image *reference, const weft_image *test,
                                                  weft_picture_quality *result, weft_error *error)
{
    long pixels;
    try {
        const std::vector<uint8_t> whole(static_cast<size_t>(reference->width) * static_cast<size_t>(reference->height),
                                         1);
        return weft_picture_quality_by_region(reference, test, whole.data(), 1, result, &pixels, error);
    } catch (const std::bad_alloc &) {
        return weft_fail_memory(error, "pictures", 0);
    }
}
