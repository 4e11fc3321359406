/* Writes example.weft and example.btf.h5 into the working folder, for the scripts that read them with other tools. */
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/tiny_dataset.h"

#include <stdio.h>
#include <stdlib.h>

int main(void)
{
    weft_error error = {0};
    weft_bytes_write_example("example.weft");
    weft_dataset_layout layout = tiny_layout(6, 5, 3, 4);
    weft_code code = tiny_dataset_write("example.btf.h5", &layout, tiny_distinct, &error);
    weft_dataset_layout_free(&layout);
    if (code != WEFT_OK)
        fprintf(stderr, "%s\n", error.message);
    return code == WEFT_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
