// A string, byte by byte, without reading past its end.
void copy(char *to, char *from)
{
    while ((*to++ = *from++))
        ;
}
