/* For the bridges to OpenCV alone: no exception leaves them. C++. */
#ifndef WEFT_REGISTRATION_POSE_OPENCV_GUARD_H
#define WEFT_REGISTRATION_POSE_OPENCV_GUARD_H

#include "base/status.h"

#include <exception>
#include <new>

/* The code of work(), or WEFT_SYSTEM saying what failed where it throws. */
template <typename Work> weft_code weft_opencv_guarded(const char *what, weft_error *error, Work work)
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return weft_fail_memory(error, what, 0);
    } catch (const std::exception &failure) {
        return weft_fail(error, WEFT_SYSTEM, "%s failed in OpenCV: %s", what, failure.what());
    } catch (...) {
        return weft_fail(error, WEFT_SYSTEM, "%s failed in OpenCV", what);
    }
}

#endif
