#include "study/inspect/verify.h"

#include "base/atomic_file.h"
#include "base/picture/image.h"

#include <limits.h>
#include <stdlib.h>
#include <zlib.h>

static const size_t largest_photograph = (size_t)1 << 32;

static weft_code check_bytes(const char *path, const weft_shot_record *record, weft_error *error)
{
    char *bytes;
    size_t size;
    WEFT_TRY(weft_read_file(path, largest_photograph, &bytes, &size, error));
    uint32_t crc = (uint32_t)crc32_z(crc32_z(0, NULL, 0), (const unsigned char *)bytes, size);
    free(bytes);
    if (size != record->bytes)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %zu bytes, but %llu in the journal", path, size,
                         (unsigned long long)record->bytes);
    if (crc != record->crc32)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has the checksum %08x, but %08x in the journal", path, crc,
                         record->crc32);
    return WEFT_OK;
}

static weft_code check_photograph(const weft_session *session, int shot, uint16_t *pixels, weft_error *error)
{
    char path[PATH_MAX];
    weft_session_photograph_path(session, shot, path, (int)sizeof path);
    WEFT_TRY(check_bytes(path, &session->record[shot], error));
    return weft_photograph_read(path, session->camera.width, session->camera.height, session->bits, pixels, error);
}

weft_code weft_verify_session(const weft_session *session, const weft_progress *progress, json_t *description,
                              weft_error *error)
{
    size_t samples = 3 * (size_t)session->camera.width * (size_t)session->camera.height;
    uint16_t *pixels = malloc(samples * sizeof *pixels);
    weft_code code = pixels ? WEFT_OK : weft_fail_memory(error, "photograph", samples * sizeof *pixels);
    int checked = 0;
    for (int i = 0; i < session->shot_count && code == WEFT_OK; i++) {
        if (session->record[i].taken) {
            code = check_photograph(session, i, pixels, error);
            checked++;
        }
        weft_progress_report(progress, "checking photographs", i + 1, session->shot_count);
    }
    free(pixels);
    if (json_object_set_new(description, "verified", json_pack("{s:i}", "photographs", checked)) != 0 &&
        code == WEFT_OK)
        code = weft_fail_memory(error, "description", 0);
    return code;
}
