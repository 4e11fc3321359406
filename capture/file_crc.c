#include "capture/file_crc.h"

#include "base/atomic_file.h"

#include <stdlib.h>
#include <zlib.h>

enum { MAX_FILE_BYTES = 1 << 30 };

weft_code weft_file_crc(const char *path, uint64_t *bytes, uint32_t *crc, weft_error *error)
{
    char *content = NULL;
    size_t size;
    WEFT_TRY(weft_read_file(path, MAX_FILE_BYTES, &content, &size, error));
    *bytes = size;
    *crc = (uint32_t)crc32(crc32(0, Z_NULL, 0), (const Bytef *)content, (uInt)size);
    free(content);
    return WEFT_OK;
}
