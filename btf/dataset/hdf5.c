#include "btf/dataset/hdf5.h"

#include <stdbool.h>
#include <stdio.h>

void weft_hdf5_quiet(void)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

static herr_t keep_description(unsigned depth, const H5E_error2_t *entry, void *text)
{
    (void)depth;
    if (entry->desc)
        snprintf(text, WEFT_MESSAGE_SIZE / 2, "%s", entry->desc);
    return 0;
}

const char *weft_hdf5_cause(void)
{
    static char text[WEFT_MESSAGE_SIZE / 2];
    text[0] = '\0';
    /* Downward ends at the function that found the trouble. */
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_description, text);
    return text;
}

hid_t weft_hdf5_half_type(void)
{
    hid_t type = H5Tcopy(H5T_IEEE_F32LE);
    if (type < 0)
        return type;
    /* Fields first: shrinking the type below its fields is refused. */
    if (H5Tset_fields(type, 15, 10, 5, 0, 10) < 0 || H5Tset_size(type, 2) < 0 || H5Tset_ebias(type, 15) < 0) {
        H5Tclose(type);
        return H5I_INVALID_HID;
    }
    return type;
}

static H5T_conv_ret_t refuse_number(H5T_conv_except_t what, hid_t from, hid_t to, void *number, void *result,
                                    void *none)
{
    (void)from, (void)number, (void)result, (void)none;
    if (H5Tget_class(to) != H5T_INTEGER || what == H5T_CONV_EXCEPT_PRECISION)
        return H5T_CONV_UNHANDLED;
    H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_DATATYPE, H5E_BADRANGE,
             "holds a number that is negative, too large or not whole");
    return H5T_CONV_ABORT;
}

hid_t weft_hdf5_whole_transfer(void)
{
    hid_t transfer = H5Pcreate(H5P_DATASET_XFER);
    if (transfer >= 0)
        H5Pset_type_conv_cb(transfer, refuse_number, NULL);
    return transfer;
}

/* ---- How much of a dataset's filtered chunks stays decoded ---- */

static const size_t chunk_cache_bytes = (size_t)1 << 27, least_cache_bytes = (size_t)1 << 22, chunk_cache_slots = 12421;

/* Whole filtered chunks must be decoded to read any part of them, so they are worth keeping. Bytes of one; 0 where
 * chunks are not filtered, or there are none. */
static size_t filtered_chunk_bytes(hid_t object)
{
    hsize_t side[H5S_MAX_RANK];
    hid_t creation = H5Dget_create_plist(object), type = H5Dget_type(object);
    int rank = 0;
    if (creation >= 0 && H5Pget_nfilters(creation) > 0 && H5Pget_layout(creation) == H5D_CHUNKED)
        rank = H5Pget_chunk(creation, H5S_MAX_RANK, side);
    size_t bytes = rank > 0 ? H5Tget_size(type) : 0;
    for (int i = 0; i < rank; i++)
        bytes *= (size_t)side[i];
    H5Tclose(type);
    H5Pclose(creation);
    return bytes;
}

/* Opens a dataset with a cache of so many bytes for its chunks. */
static hid_t open_with_cache(hid_t file, const char *name, size_t bytes)
{
    hid_t access = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(access, chunk_cache_slots, bytes, 1);
    hid_t object = H5Dopen2(file, name, access);
    H5Pclose(access);
    return object;
}

hid_t weft_hdf5_open_cached(hid_t file, const char *name)
{
    hid_t object = H5Dopen2(file, name, H5P_DEFAULT);
    if (object < 0)
        return object;
    size_t bytes = filtered_chunk_bytes(object) > 0 ? chunk_cache_bytes : 0;
    H5Dclose(object);
    return open_with_cache(file, name, bytes);
}

/* Bytes of a cache that serves reading block by block: neighbouring blocks may share chunks. */
static size_t block_cache_bytes(size_t chunk_bytes)
{
    size_t bytes = chunk_bytes < (chunk_cache_bytes >> 2) ? 4 * chunk_bytes : chunk_cache_bytes;
    return bytes > least_cache_bytes ? bytes : least_cache_bytes;
}

weft_code weft_dataset_limit_cache(weft_dataset *dataset, uint64_t *bytes, weft_error *error)
{
    static const char *const name[] = {"samples", "mask", "opacity", "frame"};
    hid_t *const object[] = {&dataset->samples, &dataset->mask, &dataset->opacity, &dataset->frames};
    *bytes = 0;
    for (size_t i = 0; i < sizeof object / sizeof *object; i++) {
        size_t chunk = *object[i] >= 0 ? filtered_chunk_bytes(*object[i]) : 0;
        if (chunk == 0)
            continue;
        /* Encoded, and decoded where it does not fit into the cache. */
        *bytes += block_cache_bytes(chunk) + 2 * chunk;
        H5Dclose(*object[i]);
        *object[i] = open_with_cache(dataset->file, name[i], block_cache_bytes(chunk));
        if (*object[i] < 0)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': cannot open '%s': %s", dataset->path, name[i],
                             weft_hdf5_cause());
    }
    return WEFT_OK;
}
