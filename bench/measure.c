#include "bench/measure.h"

#include "base/clock.h"
#include "base/numeric/error_summary.h"

#include <stdio.h>
#include <stdlib.h>

void bench_stop_on(const char *program, weft_code code, const weft_error *error)
{
    if (code == WEFT_OK)
        return;
    fprintf(stderr, "%s: %s\n", program, error->message);
    exit((int)code);
}

double bench_now_ms(clockid_t clock)
{
    return 1e3 * weft_clock_seconds(clock);
}

double bench_relative_rmse(const weft_image *image, const weft_image *reference, const weft_image *background)
{
    weft_error_sums sums = {0};
    for (size_t i = 0; i < 3 * (size_t)reference->width * (size_t)reference->height; i++) {
        if (reference->pixels[i] != background->pixels[i])
            weft_error_sums_add_value(&sums, (double)reference->pixels[i], (double)image->pixels[i]);
    }
    return weft_error_sums_relative_rmse(&sums);
}
