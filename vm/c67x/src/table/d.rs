//! Rows of the .D units that do arithmetic.

/// Appends these rows to the previous ones and continues with the next file; see [`crate::for_each_form!`].
#[doc(hidden)]
#[macro_export]
macro_rules! rows_of_d {
    ($m:ident $($before:tt)*) => {
        $crate::rows_of_loads! { $m $($before)*
            /// `dst = s2 + s1`
            AddDRRR = Add.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_0840 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + s1`
            AddDU5RR = Add.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_0940 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 - s1`
            SubDRRR = Sub.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_08C0 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 - s1`
            SubDU5RR = Sub.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_09C0 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + s1`
            AddabDRRR = Addab.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_1840 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + s1`
            AddabDU5RR = Addab.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_1940 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + 2*s1`
            AddahDRRR = Addah.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_1A40 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + 2*s1`
            AddahDU5RR = Addah.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_1B40 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + 4*s1`
            AddawDRRR = Addaw.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_1C40 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + 4*s1`
            AddawDU5RR = Addaw.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_1D40 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 - s1`
            SubabDRRR = Subab.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_18C0 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 - s1`
            SubabDU5RR = Subab.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_19C0 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 - 2*s1`
            SubahDRRR = Subah.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_1AC0 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 - 2*s1`
            SubahDU5RR = Subah.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_1BC0 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 - 4*s1`
            SubawDRRR = Subaw.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_1CC0 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 - 4*s1`
            SubawDU5RR = Subaw.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_1DC0 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + 8*s1`
            AddadDRRR = Addad.D.r_r_r { src2: R, src1: R, dst: R }, word 0x0000_1E40 of 0x0000_1FFC, Single, Base;
            /// `dst = s2 + 8*s1`
            AddadDU5RR = Addad.D.u5_r_r { src2: R, src1: U5, dst: R }, word 0x0000_1EC0 of 0x0000_1FFC, Single, Base;
        }
    };
}
