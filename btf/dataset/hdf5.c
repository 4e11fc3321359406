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
