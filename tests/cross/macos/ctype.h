/* kinds of letters */
#ifndef MACOS_STUB_CTYPE_H
#define MACOS_STUB_CTYPE_H

int isalnum(int letter);
int isdigit(int letter);
int isspace(int letter);
int tolower(int letter);
int toupper(int letter);

#endif /* MACOS_STUB_CTYPE_H */
