#include "btf/session/lens.h"
#include "tests/support/fuzz.h"

#include <math.h>
#include <stdlib.h>

void fuzz_write_seed(const char *path)
{
    weft_lens lens = {.camera = {.width = 640,
                                 .height = 480,
                                 .fx = 536.1,
                                 .fy = 536.2,
                                 .cx = 342.4,
                                 .cy = 235.5,
                                 .k1 = -0.265,
                                 .k2 = -0.047,
                                 .p1 = 0.0018,
                                 .p2 = -0.0003,
                                 .k3 = 0.25},
                      .rms_px = 0.3};
    const weft_lens_photograph photograph[] = {{"a.jpg", NULL}, {"b.jpg", "no board in it"}};
    if (weft_lens_write(path, &lens, "chessboard:9x6:25", photograph, 2, NULL) != WEFT_OK)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_lens lens;
    weft_error error = {0};
    weft_code code = weft_lens_read(fuzz_file(bytes, size), &lens, &error);
    if (code != WEFT_OK && (error.code != code || !error.message[0]))
        abort();
    /* What was read can be computed with: the inverse ends, whatever the lens. */
    for (int i = 0; code == WEFT_OK && i < 9; i++) {
        weft_pixel at = {lens.camera.width * (i % 3 - 0.5), lens.camera.height * (i / 3 - 0.5)};
        weft_pixel back = weft_camera_undistort(&lens.camera, at);
        if (!isfinite(back.x) || !isfinite(back.y))
            abort();
    }
    return 0;
}
