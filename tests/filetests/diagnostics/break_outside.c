//@ exit: 1
//@ snapshot
main()
{
    break;
    goto nowhere;
    case 3: ;
}
