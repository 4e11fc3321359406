#include "import/bonn/reader.h"

#include "base/atomic_file.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

weft_code weft_bonn_reader_open(const char *path, weft_bonn_reader *reader, weft_error *error)
{
    struct stat status;
    *reader = (weft_bonn_reader){.path = path, .stream = fopen(path, "rbe"), .section = "first bytes"};
    if (!reader->stream)
        return weft_fail_reading(error, "open", path);
    if (fstat(fileno(reader->stream), &status) == 0 && S_ISREG(status.st_mode)) {
        reader->left = (uint64_t)status.st_size;
        return WEFT_OK;
    }
    fclose(reader->stream);
    reader->stream = NULL;
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' is no file", path);
}

weft_code weft_bonn_reader_expect(const weft_bonn_reader *reader, uint64_t bytes, weft_error *error)
{
    if (bytes > reader->left)
        return weft_fail(error, WEFT_DAMAGED, "'%s' ends in its %s", reader->path, reader->section);
    return WEFT_OK;
}

weft_code weft_bonn_reader_take(weft_bonn_reader *reader, void *to, uint64_t bytes, weft_error *error)
{
    WEFT_TRY(weft_bonn_reader_expect(reader, bytes, error));
    if (fread(to, 1, bytes, reader->stream) != bytes)
        return weft_fail(error, WEFT_SYSTEM, "cannot read the %s of '%s'", reader->section, reader->path);
    reader->left -= bytes;
    return WEFT_OK;
}

weft_code weft_bonn_reader_skip(weft_bonn_reader *reader, uint64_t bytes, weft_error *error)
{
    WEFT_TRY(weft_bonn_reader_expect(reader, bytes, error));
    if (fseeko(reader->stream, (off_t)bytes, SEEK_CUR) != 0)
        return weft_fail_errno(error, "read", reader->path);
    reader->left -= bytes;
    return WEFT_OK;
}

weft_code weft_bonn_reader_byte(weft_bonn_reader *reader, uint8_t *number, weft_error *error)
{
    return weft_bonn_reader_take(reader, number, 1, error);
}

weft_code weft_bonn_reader_whole(weft_bonn_reader *reader, uint32_t *number, weft_error *error)
{
    uint8_t bytes[4];
    WEFT_TRY(weft_bonn_reader_take(reader, bytes, sizeof bytes, error));
    *number = weft_bonn_whole_of(bytes);
    return WEFT_OK;
}

weft_code weft_bonn_reader_singles(weft_bonn_reader *reader, float *number, int count, weft_error *error)
{
    for (int i = 0; i < count; i++) {
        uint8_t bytes[4];
        WEFT_TRY(weft_bonn_reader_take(reader, bytes, sizeof bytes, error));
        number[i] = weft_bonn_single_of(bytes);
    }
    return WEFT_OK;
}

float weft_bonn_single_of(const uint8_t bytes[4])
{
    uint32_t bits = weft_bonn_whole_of(bytes);
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

double weft_bonn_double_of(const uint8_t bytes[8])
{
    uint64_t bits = weft_bonn_whole_of(bytes) | (uint64_t)weft_bonn_whole_of(bytes + 4) << 32;
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}
