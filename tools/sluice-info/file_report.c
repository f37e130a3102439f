#include "file_report.h"

bool report_file(const char *path, bool json, FILE *out)
{
#ifdef HAVE_NEURAL
    if (is_neural_file(path))
        return report_neural_file(path, json, out);
#endif
    return is_catalogue(path) ? report_catalogue(path, json, out)
                              : report_texture_file(path, json, out);
}

bool report_takes(const char *path)
{
#ifdef HAVE_NEURAL
    if (is_neural_file(path))
        return true;
#endif
    return is_texture_file(path) || is_catalogue(path);
}
