#include "edit/tile/fourier.h"

#include <opencv2/core.hpp>

#include <exception>
#include <new>

extern "C" weft_code weft_fourier_transform(double *values, int width, int height, int inverse, weft_error *error)
{
    try {
        cv::Mat all(height, width, CV_64FC2, values);
        cv::dft(all, all, inverse ? cv::DFT_INVERSE | cv::DFT_SCALE : 0);
        if (all.ptr<double>() != values)
            return weft_fail(error, WEFT_SYSTEM, "OpenCV moved a Fourier transform of %d x %d", width, height);
        return WEFT_OK;
    } catch (const std::bad_alloc &) {
        return weft_fail_memory(error, "Fourier transform", 0);
    } catch (const std::exception &failure) {
        return weft_fail(error, WEFT_SYSTEM, "Fourier transform of %d x %d failed: %s", width, height, failure.what());
    } catch (...) {
        return weft_fail(error, WEFT_SYSTEM, "Fourier transform of %d x %d failed", width, height);
    }
}

extern "C" int weft_fourier_size(int n)
{
    try {
        int size = cv::getOptimalDFTSize(n);
        return size >= n ? size : n;
    } catch (...) {
        return n;
    }
}
