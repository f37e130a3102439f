#include <sluice/sluice.h>

#include <string.h>

int main(void)
{
    return strcmp(sluiceGetResultName(SLUICE_SUCCESS), "SLUICE_SUCCESS");
}
