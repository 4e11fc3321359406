/* Size and checksum of a file: how the journal knows a photograph again. */
#ifndef WEFT_CAPTURE_FILE_CRC_H
#define WEFT_CAPTURE_FILE_CRC_H

#include "base/status.h"

#include <stdint.h>

/* CRC-32 (ISO 3309, as in zlib) of all bytes of a file. Thread-safe. Errors: WEFT_BAD_INPUT where it cannot be read. */
weft_code weft_file_crc(const char *path, uint64_t *bytes, uint32_t *crc32, weft_error *error);

#endif
