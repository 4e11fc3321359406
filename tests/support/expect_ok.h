/* The test ends with the message where something that must go well does not. */
#ifndef WEFT_TESTS_EXPECT_OK_H
#define WEFT_TESTS_EXPECT_OK_H

#include "base/status.h"
#include "tests/support/cmocka_all.h"

static inline void expect_ok(weft_code code, const weft_error *error)
{
    if (code != WEFT_OK)
        fail_msg("%s", error->message);
}

#endif
