#include "compress/weave_fit/fit_weave.h"

#include "btf/dataset/fingerprint.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST_NAME = 160 };

/* The name of a file without its folder, fit for a comment. */
static void name_of(const char *path, char name[LONGEST_NAME])
{
    const char *slash = strrchr(path, '/');
    snprintf(name, LONGEST_NAME, "%s", slash ? slash + 1 : path);
    for (char *c = name; *c; c++)
        if (*c == '*' || *c == '\'' || (unsigned char)*c < ' ')
            *c = '_';
}

weft_code weft_fit_weave_write(const char *path, const weft_weave *weave, weft_dataset *dataset,
                               const weft_fit_weave_report *report, weft_error *error)
{
    weft_dataset_fingerprint of;
    char name[LONGEST_NAME], comment[512];
    WEFT_TRY(weft_dataset_fingerprint_take(dataset, &of, error));
    name_of(weft_dataset_path(dataset), name);
    snprintf(comment, sizeof comment,
             "Fitted to the mean of %d images of '%s' (layout %08" PRIx32 ", samples %08" PRIx32
             "); relative error of the mean BRDF: median %.2f %%, 80th percentile %.2f %%",
             report->image_count, name, of.layout, of.samples, 100 * report->after.median_relative,
             100 * report->after.percentile80_relative);
    return weft_weave_write(path, weave, comment, error);
}

static weft_code read_first_line(const char *path, char *line, int size, weft_error *error)
{
    FILE *file = fopen(path, "r");
    if (!file)
        return weft_fail_errno(error, "open", path);
    if (!fgets(line, size, file))
        line[0] = '\0';
    fclose(file);
    return WEFT_OK;
}

weft_code weft_fit_weave_origin(const char *path, weft_dataset *dataset, char origin[WEFT_MESSAGE_SIZE],
                                weft_error *error)
{
    char line[1024], name[LONGEST_NAME];
    weft_dataset_fingerprint said, own;
    int images;
    WEFT_TRY(read_first_line(path, line, sizeof line, error));
    if (sscanf(line, "/* Fitted to the mean of %d images of '%159[^']' (layout %" SCNx32 ", samples %" SCNx32 ")",
               &images, name, &said.layout, &said.samples) != 4) {
        snprintf(origin, WEFT_MESSAGE_SIZE, "as its file gives it, fitted to no dataset");
        return WEFT_OK;
    }
    WEFT_TRY(weft_dataset_fingerprint_take(dataset, &own, error));
    if (said.layout == own.layout && said.samples == own.samples)
        snprintf(origin, WEFT_MESSAGE_SIZE, "fitted to this dataset, the mean of %d images", images);
    else
        snprintf(origin, WEFT_MESSAGE_SIZE, "fitted to another dataset, the mean of %d images of '%s'", images, name);
    return WEFT_OK;
}
