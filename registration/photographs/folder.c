#include "base/picture/colour_claim.h"
#include "base/text/image_list.h"
#include "registration/photographs/steps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Photographs are relative to white paper, so a matrix that moves white is not for them: CIE XYZ. */
static bool keeps_white(const weft_colour_space *space)
{
    for (int i = 0; i < 3; i++) {
        if (fabs(space->matrix[i][0] + space->matrix[i][1] + space->matrix[i][2] - 1) > 1e-3)
            return false;
    }
    return true;
}

static void take_colours(const weft_colour_claim *claim, weft_photographs_photograph *photograph)
{
    bool is_raw = photograph->exif.is_linear && !photograph->exif.is_float;
    if (is_raw)
        return;
    bool is_clear = claim->kind == WEFT_CLAIM_CLEAR;
    photograph->assumes_srgb = claim->kind == WEFT_CLAIM_NONE && !photograph->exif.is_linear;
    if (claim->kind == WEFT_CLAIM_NONE || (is_clear && weft_colour_space_has_srgb_primaries(&claim->space)))
        return;
    snprintf(photograph->colours, sizeof photograph->colours, "%s", claim->words);
    if (!is_clear || !keeps_white(&claim->space))
        return;
    photograph->file_colour.terms = WEFT_COLOUR_LINEAR_TERMS;
    for (int i = 0; i < 3; i++)
        memcpy(photograph->file_colour.matrix[i], claim->space.matrix[i], sizeof claim->space.matrix[i]);
}

/* A file that cannot be read is left out; a lack of memory is not the file's fault and ends the command. */
static weft_code read_exif(const char *folder, weft_photographs_photograph *photograph, weft_error *error)
{
    char *path;
    if (asprintf(&path, "%s/%s", folder, photograph->name) < 0)
        return weft_fail_memory(error, "path", strlen(folder) + strlen(photograph->name) + 2);
    weft_colour_claim claim;
    weft_code code = weft_colour_claim_read(path, NULL, NULL, &photograph->exif, &claim, error);
    free(path);
    if (code == WEFT_OK)
        take_colours(&claim, photograph);
    else if (weft_class_of(code) == WEFT_BAD_INPUT)
        snprintf(photograph->remark, sizeof photograph->remark, "%.180s", error->message);
    else
        return code;
    return WEFT_OK;
}

static weft_code read_all_exif(const char *folder, weft_photograph_set *set, weft_error *error)
{
    weft_code first = WEFT_OK;
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < set->count; i++) {
        weft_error own = {0};
        weft_code code = read_exif(folder, &set->photograph[i], &own);
#pragma omp critical(weft_read_all_exif)
        if (code != WEFT_OK && first == WEFT_OK) {
            first = code;
            *error = own;
        }
    }
    return first;
}

const weft_exif *weft_photographs_common_size(const weft_photograph_set *set)
{
    const weft_exif *best = NULL;
    int most = 0;
    for (int i = 0; i < set->count; i++) {
        const weft_exif *one = &set->photograph[i].exif;
        int same = 0;
        for (int k = 0; k < set->count && weft_photographs_used(&set->photograph[i]); k++)
            same += weft_photographs_used(&set->photograph[k]) && set->photograph[k].exif.width == one->width &&
                    set->photograph[k].exif.height == one->height;
        if (same > most)
            most = same, best = one;
    }
    return best;
}

static void leave_out_other_sizes(weft_photograph_set *set, const weft_exif *common)
{
    for (int i = 0; i < set->count; i++) {
        weft_photographs_photograph *p = &set->photograph[i];
        if (!weft_photographs_used(p) || (p->exif.width == common->width && p->exif.height == common->height))
            continue;
        bool turned = p->exif.width == common->height && p->exif.height == common->width;
        snprintf(p->remark, sizeof p->remark, "it has %d x %d pixels, most have %d x %d%s", p->exif.width,
                 p->exif.height, common->width, common->height,
                 turned ? ": a program turned it; copy the files as the camera wrote them" : "");
    }
}

static weft_code name_photographs(const char *folder, const weft_lines *names, weft_photograph_set *set,
                                  weft_error *error)
{
    if (names->count == 0)
        return weft_images_missing(folder, error);
    if (names->count < WEFT_PHOTOGRAPHS_FEWEST)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' holds %d photograph%s, %d are needed and 20 do better: take more, each with the camera "
                         "and the lamp elsewhere",
                         folder, names->count, names->count == 1 ? "" : "s", WEFT_PHOTOGRAPHS_FEWEST);
    if (!(set->photograph = calloc((size_t)names->count, sizeof *set->photograph)))
        return weft_fail_memory(error, "photographs", (size_t)names->count * sizeof *set->photograph);
    for (int i = 0; i < names->count; i++, set->count++) {
        if (!(set->photograph[i].name = strdup(names->line[i])))
            return weft_fail_memory(error, names->line[i], strlen(names->line[i]));
    }
    return WEFT_OK;
}

/* Lenses without contacts write no aperture. What no photograph states is taken as the same in all. */
static weft_code complete_exposures(weft_photograph_set *set, weft_error *error)
{
    int used = 0, timed = 0, with_aperture = 0, with_iso = 0;
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        if (!weft_photographs_used(p))
            continue;
        used++;
        timed += p->exif.exposure_s > 0;
        with_aperture += p->exif.f_number > 0;
        with_iso += p->exif.iso > 0;
    }
    if (timed < used || (with_aperture > 0 && with_iso > 0))
        return WEFT_OK;
    for (int i = 0; i < set->count; i++) {
        weft_exif *exif = &set->photograph[i].exif;
        exif->f_number = with_aperture > 0 ? exif->f_number : 1;
        exif->iso = with_iso > 0 ? exif->iso : 100;
    }
    return weft_lines_add(&set->notes, error, "no photograph states its %s: %s taken as the same in all",
                          with_aperture > 0 ? "sensitivity"
                          : with_iso > 0    ? "aperture"
                                            : "aperture and sensitivity",
                          with_aperture > 0 || with_iso > 0 ? "it is" : "both are");
}

weft_code weft_photographs_list(const char *folder, weft_photograph_set *set, weft_error *error)
{
    weft_lines names;
    WEFT_TRY(weft_images_list(folder, &names, error));
    weft_code code = name_photographs(folder, &names, set, error);
    weft_lines_free(&names);
    WEFT_TRY(code);
    WEFT_TRY(read_all_exif(folder, set, error));
    const weft_exif *common = weft_photographs_common_size(set);
    if (!common)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "none of the %d images in '%s' can be read: %s; save them as JPEG, TIFF or DNG", set->count,
                         folder, set->photograph[0].remark);
    leave_out_other_sizes(set, common);
    return complete_exposures(set, error);
}

/* ---- What the files say of their colours ---- */

static bool says_the_same(const weft_photographs_photograph *p, const weft_photographs_photograph *q)
{
    return weft_photographs_used(q) && strcmp(p->colours, q->colours) == 0;
}

weft_code weft_photographs_note_colours(weft_photograph_set *set, weft_error *error)
{
    int used = 0, assumed = 0;
    for (int i = 0; i < set->count; i++) {
        used += weft_photographs_used(&set->photograph[i]);
        assumed += weft_photographs_used(&set->photograph[i]) && set->photograph[i].assumes_srgb;
    }
    if (assumed > 0)
        WEFT_TRY(
            weft_lines_add(&set->notes, error,
                           "colours: sRGB assumed, as %d of %d photographs do not say theirs; --colour gives those "
                           "of the camera",
                           assumed, used));
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        int before = 0, same = 0;
        for (int k = 0; k < set->count; k++) {
            same += says_the_same(p, &set->photograph[k]);
            before += k < i && says_the_same(p, &set->photograph[k]);
        }
        if (!weft_photographs_used(p) || !p->colours[0] || before > 0)
            continue;
        WEFT_TRY(weft_lines_add(&set->notes, error, "colours of '%s': %s; %s (%d of %d photographs)", p->name,
                                p->colours, p->file_colour.terms ? "turned into sRGB" : "not turned into sRGB", same,
                                used));
    }
    return WEFT_OK;
}
