#include "io/image_file.h"
