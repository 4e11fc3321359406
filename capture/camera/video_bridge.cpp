#include "capture/camera/video_library.h"

#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>
#include <string>

struct weft_video {
    cv::VideoCapture capture;
    std::string name;
};

namespace
{

/* Video for Linux counts exposures in 0.1 ms, and 1 is its manual mode. */
const double exposure_unit_s = 1e-4, manual_mode = 1;

template <typename Work> weft_code guarded(weft_error *error, Work work)
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return weft_fail_memory(error, "video camera", 0);
    } catch (const std::exception &failure) {
        return weft_fail(error, WEFT_SYSTEM, "video camera: %s", failure.what());
    } catch (...) {
        return weft_fail(error, WEFT_SYSTEM, "video camera: OpenCV failed");
    }
}

weft_code open_video(const char *device, weft_video **video, weft_error *error)
{
    return guarded(error, [&] {
        char *end;
        cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); /* errors are returned */
        long number = std::strtol(device, &end, 10);
        auto opened = std::make_unique<weft_video>();
        opened->name = device;
        bool is_number = *device && !*end;
        bool open = is_number ? opened->capture.open(int(number)) : opened->capture.open(opened->name);
        if (!open)
            return weft_fail(error, WEFT_SYSTEM, "video camera: cannot open '%s'", device);
        *video = opened.release();
        return WEFT_OK;
    });
}

void close_video(weft_video *video)
{
    delete video;
}

weft_code set_exposure(weft_video *video, double exposure_s, double *said_s, weft_error *error)
{
    return guarded(error, [&] {
        video->capture.set(cv::CAP_PROP_AUTO_EXPOSURE, manual_mode);
        video->capture.set(cv::CAP_PROP_EXPOSURE, exposure_s / exposure_unit_s);
        double said = video->capture.get(cv::CAP_PROP_EXPOSURE);
        *said_s = said > 0 ? said * exposure_unit_s : 0;
        return WEFT_OK;
    });
}

weft_code convert(const cv::Mat &frame, weft_image *image, weft_error *error)
{
    bool deep = frame.depth() == CV_16U;
    if (!deep && frame.depth() != CV_8U)
        return weft_fail(error, WEFT_SYSTEM, "video camera: frames have neither 8 nor 16 bits");
    WEFT_TRY(weft_image_create(frame.cols, frame.rows, image, error));
    cv::Mat values;
    frame.convertTo(values, CV_32F, deep ? 1.0 / 65535 : 1.0 / 255);
    int channels = values.channels();
    for (int y = 0; y < values.rows; y++) {
        const float *from = values.ptr<float>(y);
        float *to = image->pixels + 3 * size_t(y) * size_t(values.cols);
        for (int x = 0; x < values.cols; x++, from += channels, to += 3) {
            for (int k = 0; k < 3; k++)
                to[k] = channels < 3 ? from[0] : from[2 - k]; /* OpenCV: blue first */
        }
    }
    return WEFT_OK;
}

weft_code read_frame(weft_video *video, int skip, weft_image *image, weft_error *error)
{
    return guarded(error, [&] {
        cv::Mat frame;
        for (int i = 0; i < skip; i++)
            video->capture.grab();
        if (!video->capture.read(frame) || frame.empty())
            return weft_fail(error, WEFT_SYSTEM, "video camera: '%s' delivers no frame", video->name.c_str());
        return convert(frame, image, error);
    });
}

} // namespace

const weft_video_library weft_video_library_table = {open_video, close_video, set_exposure, read_frame};
