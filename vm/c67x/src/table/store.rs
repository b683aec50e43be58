//! Rows of the .D units that store.

/// Appends these rows to the previous ones and passes all of them to the macro `$m`; see [`crate::for_each_form!`].
#[doc(hidden)]
#[macro_export]
macro_rules! rows_of_stores {
    ($m:ident $($before:tt)*) => {
        $m! { $($before)*
            /// `a = R - 1*off; mem8[a] = src[7:0]`
            StbNegC = Stb.D.neg_c { src: R, mem: NegC }, word 0x0000_0034 of 0x0000_1F7C, Store, Base;
            /// `a = R + 1*off; mem8[a] = src[7:0]`
            StbPosC = Stb.D.pos_c { src: R, mem: PosC }, word 0x0000_0234 of 0x0000_1F7C, Store, Base;
            /// `a = R - 1*off; mem8[a] = src[7:0]`
            StbNegR = Stb.D.neg_r { src: R, mem: NegR }, word 0x0000_0834 of 0x0000_1F7C, Store, Base;
            /// `a = R + 1*off; mem8[a] = src[7:0]`
            StbPosR = Stb.D.pos_r { src: R, mem: PosR }, word 0x0000_0A34 of 0x0000_1F7C, Store, Base;
            /// `a = R = R - 1*off; mem8[a] = src[7:0]`
            StbPredecC = Stb.D.predec_c { src: R, mem: PredecC }, word 0x0000_1034 of 0x0000_1F7C, Store, Base;
            /// `a = R = R + 1*off; mem8[a] = src[7:0]`
            StbPreincC = Stb.D.preinc_c { src: R, mem: PreincC }, word 0x0000_1234 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R - 1*off; mem8[a] = src[7:0]`
            StbPostdecC = Stb.D.postdec_c { src: R, mem: PostdecC }, word 0x0000_1434 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R + 1*off; mem8[a] = src[7:0]`
            StbPostincC = Stb.D.postinc_c { src: R, mem: PostincC }, word 0x0000_1634 of 0x0000_1F7C, Store, Base;
            /// `a = R = R - 1*off; mem8[a] = src[7:0]`
            StbPredecR = Stb.D.predec_r { src: R, mem: PredecR }, word 0x0000_1834 of 0x0000_1F7C, Store, Base;
            /// `a = R = R + 1*off; mem8[a] = src[7:0]`
            StbPreincR = Stb.D.preinc_r { src: R, mem: PreincR }, word 0x0000_1A34 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R - 1*off; mem8[a] = src[7:0]`
            StbPostdecR = Stb.D.postdec_r { src: R, mem: PostdecR }, word 0x0000_1C34 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R + 1*off; mem8[a] = src[7:0]`
            StbPostincR = Stb.D.postinc_r { src: R, mem: PostincR }, word 0x0000_1E34 of 0x0000_1F7C, Store, Base;
            /// `a = R - 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthNegC = Sth.D.neg_c { src: R, mem: NegC }, word 0x0000_0054 of 0x0000_1F7C, Store, Base;
            /// `a = R + 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPosC = Sth.D.pos_c { src: R, mem: PosC }, word 0x0000_0254 of 0x0000_1F7C, Store, Base;
            /// `a = R - 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthNegR = Sth.D.neg_r { src: R, mem: NegR }, word 0x0000_0854 of 0x0000_1F7C, Store, Base;
            /// `a = R + 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPosR = Sth.D.pos_r { src: R, mem: PosR }, word 0x0000_0A54 of 0x0000_1F7C, Store, Base;
            /// `a = R = R - 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPredecC = Sth.D.predec_c { src: R, mem: PredecC }, word 0x0000_1054 of 0x0000_1F7C, Store, Base;
            /// `a = R = R + 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPreincC = Sth.D.preinc_c { src: R, mem: PreincC }, word 0x0000_1254 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R - 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPostdecC = Sth.D.postdec_c { src: R, mem: PostdecC }, word 0x0000_1454 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R + 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPostincC = Sth.D.postinc_c { src: R, mem: PostincC }, word 0x0000_1654 of 0x0000_1F7C, Store, Base;
            /// `a = R = R - 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPredecR = Sth.D.predec_r { src: R, mem: PredecR }, word 0x0000_1854 of 0x0000_1F7C, Store, Base;
            /// `a = R = R + 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPreincR = Sth.D.preinc_r { src: R, mem: PreincR }, word 0x0000_1A54 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R - 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPostdecR = Sth.D.postdec_r { src: R, mem: PostdecR }, word 0x0000_1C54 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R + 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPostincR = Sth.D.postinc_r { src: R, mem: PostincR }, word 0x0000_1E54 of 0x0000_1F7C, Store, Base;
            /// `a = R - 4*off; a &= ~3; mem32[a] = src`
            StwNegC = Stw.D.neg_c { src: R, mem: NegC }, word 0x0000_0074 of 0x0000_1F7C, Store, Base;
            /// `a = R + 4*off; a &= ~3; mem32[a] = src`
            StwPosC = Stw.D.pos_c { src: R, mem: PosC }, word 0x0000_0274 of 0x0000_1F7C, Store, Base;
            /// `a = R - 4*off; a &= ~3; mem32[a] = src`
            StwNegR = Stw.D.neg_r { src: R, mem: NegR }, word 0x0000_0874 of 0x0000_1F7C, Store, Base;
            /// `a = R + 4*off; a &= ~3; mem32[a] = src`
            StwPosR = Stw.D.pos_r { src: R, mem: PosR }, word 0x0000_0A74 of 0x0000_1F7C, Store, Base;
            /// `a = R = R - 4*off; a &= ~3; mem32[a] = src`
            StwPredecC = Stw.D.predec_c { src: R, mem: PredecC }, word 0x0000_1074 of 0x0000_1F7C, Store, Base;
            /// `a = R = R + 4*off; a &= ~3; mem32[a] = src`
            StwPreincC = Stw.D.preinc_c { src: R, mem: PreincC }, word 0x0000_1274 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R - 4*off; a &= ~3; mem32[a] = src`
            StwPostdecC = Stw.D.postdec_c { src: R, mem: PostdecC }, word 0x0000_1474 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R + 4*off; a &= ~3; mem32[a] = src`
            StwPostincC = Stw.D.postinc_c { src: R, mem: PostincC }, word 0x0000_1674 of 0x0000_1F7C, Store, Base;
            /// `a = R = R - 4*off; a &= ~3; mem32[a] = src`
            StwPredecR = Stw.D.predec_r { src: R, mem: PredecR }, word 0x0000_1874 of 0x0000_1F7C, Store, Base;
            /// `a = R = R + 4*off; a &= ~3; mem32[a] = src`
            StwPreincR = Stw.D.preinc_r { src: R, mem: PreincR }, word 0x0000_1A74 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R - 4*off; a &= ~3; mem32[a] = src`
            StwPostdecR = Stw.D.postdec_r { src: R, mem: PostdecR }, word 0x0000_1C74 of 0x0000_1F7C, Store, Base;
            /// `a = R; R = R + 4*off; a &= ~3; mem32[a] = src`
            StwPostincR = Stw.D.postinc_r { src: R, mem: PostincR }, word 0x0000_1E74 of 0x0000_1F7C, Store, Base;
            /// `R = y ? B15 : B14; a = R + off; mem8[a] = src[7:0]`
            StbPosU15 = Stb.D.pos_u15 { src: R, mem: PosU15 }, word 0x0000_003C of 0x0000_007C, Store, Base;
            /// `R = y ? B15 : B14; a = R + 2*off; a &= ~1; mem16[a] = src[15:0]`
            SthPosU15 = Sth.D.pos_u15 { src: R, mem: PosU15 }, word 0x0000_005C of 0x0000_007C, Store, Base;
            /// `R = y ? B15 : B14; a = R + 4*off; a &= ~3; mem32[a] = src`
            StwPosU15 = Stw.D.pos_u15 { src: R, mem: PosU15 }, word 0x0000_007C of 0x0000_007C, Store, Base;
        }
    };
}
