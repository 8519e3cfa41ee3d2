// reference/trace/embree.hpp: whichever Embree there is. Only reference/trace includes this.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define PLUMBLINE_EMBREE 4
#else
#include <embree3/rtcore.h>
#define PLUMBLINE_EMBREE 3
#endif
