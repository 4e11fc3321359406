#include "compress/run/record.h"

#include <stdlib.h>
#include <string.h>

static bool make_room(weft_record *record, size_t size)
{
    if (record->capacity - record->size >= size)
        return true;
    size_t capacity = record->capacity + record->capacity / 2 + size;
    unsigned char *bytes = realloc(record->bytes, capacity);
    if (!bytes)
        return false;
    record->bytes = bytes;
    record->capacity = capacity;
    return true;
}

void weft_record_transfer(weft_record *record, void *value, size_t size)
{
    bool possible = record->loading ? record->size - record->at >= size : make_room(record, size);
    record->failed = record->failed || !possible;
    if (record->failed || size == 0)
        return;
    if (record->loading) {
        memcpy(value, record->bytes + record->at, size);
        record->at += size;
    } else {
        memcpy(record->bytes + record->size, value, size);
        record->size += size;
    }
}
