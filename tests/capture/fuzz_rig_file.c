#include "capture/laboratory/rig_file.h"
#include "tests/support/fuzz.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>

void fuzz_write_seed(const char *path)
{
    size_t size;
    unsigned char *text = scratch_load(WEFT_ASSETS "/rigs/goniometer.conf", &size);
    scratch_store(path, text, size);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_rig_file rig;
    weft_error error = {0};
    weft_code code = weft_rig_file_read(fuzz_file(bytes, size), &rig, &error);
    if (code != WEFT_OK && (error.code != code || !error.message[0]))
        abort();
    /* What was read can be driven: whatever is solved lies within the limits, and takes a time. */
    for (int i = 0; code == WEFT_OK && i < 81; i++) {
        weft_axis_positions positions, home = {0};
        if (weft_axes_solve(&rig.axes, weft_ubo81_angles(i), weft_ubo81_angles(80 - i), &positions, NULL) != WEFT_OK)
            continue;
        for (int k = 0; k < rig.axes.count; k++) {
            if (!(positions.deg[k] >= rig.axes.axis[k].low_deg - 1e-3) ||
                !(positions.deg[k] <= rig.axes.axis[k].high_deg + 1e-3))
                abort();
        }
        if (!isfinite(weft_axes_move_s(&rig.axes, &home, &positions)))
            abort();
    }
    return 0;
}
