#include <openpgl/openpgl.h>
