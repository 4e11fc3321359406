/* Settings that differ from the default in every value, as text. */
#ifndef WEFT_TESTS_PLAYER_SETTINGS_TEXT_H
#define WEFT_TESTS_PLAYER_SETTINGS_TEXT_H

#define SETTINGS_TEXT                                                                                                  \
    "{\"version\": 1,\n"                                                                                               \
    " \"files\": {\"material\": \"a/silk.weft\", \"dataset\": \"../silk.btf.h5\", \"weave\": \"/silk.wv\",\n"          \
    "  \"environment\": \"sky.exr\", \"mesh\": \"./drape\"},\n"                                                        \
    " \"picture\": {\"width\": 77, \"height\": 33, \"samples\": 5},\n"                                                 \
    " \"size\": {\"real\": false, \"repeat\": 0.10000000000000001, \"mesh_mm\": 3.5, \"mesh_unit_mm\": 10,\n"          \
    "  \"weave_tiles\": [2.5, 3]},\n"                                                                                  \
    " \"camera\": {\"azimuth_deg\": -71.3, \"elevation_deg\": 12.7, \"distance\": 2.2999999999999998},\n"              \
    " \"light\": {\"lights\": [{\"theta_deg\": 41.1, \"phi_deg\": 170.9, \"irradiance\": [0.3, 0.5, 0.7]},\n"          \
    "   {\"theta_deg\": 1e-3, \"phi_deg\": -0.1, \"irradiance\": [1, 2, 3]}],\n"                                       \
    "  \"shadows\": true, \"key_size_deg\": 3.1, \"ground\": true, \"exposure\": 1.7, \"tone\": \"soft\",\n"           \
    "  \"environment\": {\"lit\": true, \"turn_deg\": 33.3, \"strength\": 0.9, \"reference\": true}},\n"               \
    " \"mip\": {\"level\": \"fixed\", \"fixed_level\": 1.1, \"filter\": \"stochastic\"},\n"                            \
    " \"model\": {\"raw_format\": \"bc6h\", \"lobes\": [true, false, true], \"view_table\": false, \"light_table\": "  \
    "false,\n"                                                                                                         \
    "  \"table_bits\": 3, \"noise_seed\": 5},\n"                                                                       \
    " \"view\": {\"layout\": \"wipe\", \"modes\": [\"analytic\", \"raw\", \"compressed\"], \"panes\": 2,\n"            \
    "  \"divider\": 0.25, \"show_level\": true, \"show_extrapolation\": true, \"labels\": false}}\n"

#endif
