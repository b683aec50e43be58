//! Rows of the .D units that load.

/// Appends these rows to the previous ones and continues with the next file; see [`crate::for_each_form!`].
#[doc(hidden)]
#[macro_export]
macro_rules! rows_of_loads {
    ($m:ident $($before:tt)*) => {
        $crate::rows_of_stores! { $m $($before)*
            /// `a = R - 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuNegC = Ldhu.D.neg_c { mem: NegC, dst: R }, word 0x0000_0004 of 0x0000_1F7C, Load, Base;
            /// `a = R + 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPosC = Ldhu.D.pos_c { mem: PosC, dst: R }, word 0x0000_0204 of 0x0000_1F7C, Load, Base;
            /// `a = R - 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuNegR = Ldhu.D.neg_r { mem: NegR, dst: R }, word 0x0000_0804 of 0x0000_1F7C, Load, Base;
            /// `a = R + 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPosR = Ldhu.D.pos_r { mem: PosR, dst: R }, word 0x0000_0A04 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPredecC = Ldhu.D.predec_c { mem: PredecC, dst: R }, word 0x0000_1004 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPreincC = Ldhu.D.preinc_c { mem: PreincC, dst: R }, word 0x0000_1204 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPostdecC = Ldhu.D.postdec_c { mem: PostdecC, dst: R }, word 0x0000_1404 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPostincC = Ldhu.D.postinc_c { mem: PostincC, dst: R }, word 0x0000_1604 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPredecR = Ldhu.D.predec_r { mem: PredecR, dst: R }, word 0x0000_1804 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPreincR = Ldhu.D.preinc_r { mem: PreincR, dst: R }, word 0x0000_1A04 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPostdecR = Ldhu.D.postdec_r { mem: PostdecR, dst: R }, word 0x0000_1C04 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPostincR = Ldhu.D.postinc_r { mem: PostincR, dst: R }, word 0x0000_1E04 of 0x0000_1F7C, Load, Base;
            /// `a = R - 1*off; dst = zx8(mem[a])`
            LdbuNegC = Ldbu.D.neg_c { mem: NegC, dst: R }, word 0x0000_0014 of 0x0000_1F7C, Load, Base;
            /// `a = R + 1*off; dst = zx8(mem[a])`
            LdbuPosC = Ldbu.D.pos_c { mem: PosC, dst: R }, word 0x0000_0214 of 0x0000_1F7C, Load, Base;
            /// `a = R - 1*off; dst = zx8(mem[a])`
            LdbuNegR = Ldbu.D.neg_r { mem: NegR, dst: R }, word 0x0000_0814 of 0x0000_1F7C, Load, Base;
            /// `a = R + 1*off; dst = zx8(mem[a])`
            LdbuPosR = Ldbu.D.pos_r { mem: PosR, dst: R }, word 0x0000_0A14 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 1*off; dst = zx8(mem[a])`
            LdbuPredecC = Ldbu.D.predec_c { mem: PredecC, dst: R }, word 0x0000_1014 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 1*off; dst = zx8(mem[a])`
            LdbuPreincC = Ldbu.D.preinc_c { mem: PreincC, dst: R }, word 0x0000_1214 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 1*off; dst = zx8(mem[a])`
            LdbuPostdecC = Ldbu.D.postdec_c { mem: PostdecC, dst: R }, word 0x0000_1414 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 1*off; dst = zx8(mem[a])`
            LdbuPostincC = Ldbu.D.postinc_c { mem: PostincC, dst: R }, word 0x0000_1614 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 1*off; dst = zx8(mem[a])`
            LdbuPredecR = Ldbu.D.predec_r { mem: PredecR, dst: R }, word 0x0000_1814 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 1*off; dst = zx8(mem[a])`
            LdbuPreincR = Ldbu.D.preinc_r { mem: PreincR, dst: R }, word 0x0000_1A14 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 1*off; dst = zx8(mem[a])`
            LdbuPostdecR = Ldbu.D.postdec_r { mem: PostdecR, dst: R }, word 0x0000_1C14 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 1*off; dst = zx8(mem[a])`
            LdbuPostincR = Ldbu.D.postinc_r { mem: PostincR, dst: R }, word 0x0000_1E14 of 0x0000_1F7C, Load, Base;
            /// `a = R - 1*off; dst = sx8(mem[a])`
            LdbNegC = Ldb.D.neg_c { mem: NegC, dst: R }, word 0x0000_0024 of 0x0000_1F7C, Load, Base;
            /// `a = R + 1*off; dst = sx8(mem[a])`
            LdbPosC = Ldb.D.pos_c { mem: PosC, dst: R }, word 0x0000_0224 of 0x0000_1F7C, Load, Base;
            /// `a = R - 1*off; dst = sx8(mem[a])`
            LdbNegR = Ldb.D.neg_r { mem: NegR, dst: R }, word 0x0000_0824 of 0x0000_1F7C, Load, Base;
            /// `a = R + 1*off; dst = sx8(mem[a])`
            LdbPosR = Ldb.D.pos_r { mem: PosR, dst: R }, word 0x0000_0A24 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 1*off; dst = sx8(mem[a])`
            LdbPredecC = Ldb.D.predec_c { mem: PredecC, dst: R }, word 0x0000_1024 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 1*off; dst = sx8(mem[a])`
            LdbPreincC = Ldb.D.preinc_c { mem: PreincC, dst: R }, word 0x0000_1224 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 1*off; dst = sx8(mem[a])`
            LdbPostdecC = Ldb.D.postdec_c { mem: PostdecC, dst: R }, word 0x0000_1424 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 1*off; dst = sx8(mem[a])`
            LdbPostincC = Ldb.D.postinc_c { mem: PostincC, dst: R }, word 0x0000_1624 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 1*off; dst = sx8(mem[a])`
            LdbPredecR = Ldb.D.predec_r { mem: PredecR, dst: R }, word 0x0000_1824 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 1*off; dst = sx8(mem[a])`
            LdbPreincR = Ldb.D.preinc_r { mem: PreincR, dst: R }, word 0x0000_1A24 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 1*off; dst = sx8(mem[a])`
            LdbPostdecR = Ldb.D.postdec_r { mem: PostdecR, dst: R }, word 0x0000_1C24 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 1*off; dst = sx8(mem[a])`
            LdbPostincR = Ldb.D.postinc_r { mem: PostincR, dst: R }, word 0x0000_1E24 of 0x0000_1F7C, Load, Base;
            /// `a = R - 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhNegC = Ldh.D.neg_c { mem: NegC, dst: R }, word 0x0000_0044 of 0x0000_1F7C, Load, Base;
            /// `a = R + 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPosC = Ldh.D.pos_c { mem: PosC, dst: R }, word 0x0000_0244 of 0x0000_1F7C, Load, Base;
            /// `a = R - 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhNegR = Ldh.D.neg_r { mem: NegR, dst: R }, word 0x0000_0844 of 0x0000_1F7C, Load, Base;
            /// `a = R + 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPosR = Ldh.D.pos_r { mem: PosR, dst: R }, word 0x0000_0A44 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPredecC = Ldh.D.predec_c { mem: PredecC, dst: R }, word 0x0000_1044 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPreincC = Ldh.D.preinc_c { mem: PreincC, dst: R }, word 0x0000_1244 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPostdecC = Ldh.D.postdec_c { mem: PostdecC, dst: R }, word 0x0000_1444 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPostincC = Ldh.D.postinc_c { mem: PostincC, dst: R }, word 0x0000_1644 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPredecR = Ldh.D.predec_r { mem: PredecR, dst: R }, word 0x0000_1844 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPreincR = Ldh.D.preinc_r { mem: PreincR, dst: R }, word 0x0000_1A44 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPostdecR = Ldh.D.postdec_r { mem: PostdecR, dst: R }, word 0x0000_1C44 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPostincR = Ldh.D.postinc_r { mem: PostincR, dst: R }, word 0x0000_1E44 of 0x0000_1F7C, Load, Base;
            /// `a = R - 4*off; a &= ~3; dst = mem32[a]`
            LdwNegC = Ldw.D.neg_c { mem: NegC, dst: R }, word 0x0000_0064 of 0x0000_1F7C, Load, Base;
            /// `a = R + 4*off; a &= ~3; dst = mem32[a]`
            LdwPosC = Ldw.D.pos_c { mem: PosC, dst: R }, word 0x0000_0264 of 0x0000_1F7C, Load, Base;
            /// `a = R - 4*off; a &= ~3; dst = mem32[a]`
            LdwNegR = Ldw.D.neg_r { mem: NegR, dst: R }, word 0x0000_0864 of 0x0000_1F7C, Load, Base;
            /// `a = R + 4*off; a &= ~3; dst = mem32[a]`
            LdwPosR = Ldw.D.pos_r { mem: PosR, dst: R }, word 0x0000_0A64 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 4*off; a &= ~3; dst = mem32[a]`
            LdwPredecC = Ldw.D.predec_c { mem: PredecC, dst: R }, word 0x0000_1064 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 4*off; a &= ~3; dst = mem32[a]`
            LdwPreincC = Ldw.D.preinc_c { mem: PreincC, dst: R }, word 0x0000_1264 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 4*off; a &= ~3; dst = mem32[a]`
            LdwPostdecC = Ldw.D.postdec_c { mem: PostdecC, dst: R }, word 0x0000_1464 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 4*off; a &= ~3; dst = mem32[a]`
            LdwPostincC = Ldw.D.postinc_c { mem: PostincC, dst: R }, word 0x0000_1664 of 0x0000_1F7C, Load, Base;
            /// `a = R = R - 4*off; a &= ~3; dst = mem32[a]`
            LdwPredecR = Ldw.D.predec_r { mem: PredecR, dst: R }, word 0x0000_1864 of 0x0000_1F7C, Load, Base;
            /// `a = R = R + 4*off; a &= ~3; dst = mem32[a]`
            LdwPreincR = Ldw.D.preinc_r { mem: PreincR, dst: R }, word 0x0000_1A64 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R - 4*off; a &= ~3; dst = mem32[a]`
            LdwPostdecR = Ldw.D.postdec_r { mem: PostdecR, dst: R }, word 0x0000_1C64 of 0x0000_1F7C, Load, Base;
            /// `a = R; R = R + 4*off; a &= ~3; dst = mem32[a]`
            LdwPostincR = Ldw.D.postinc_r { mem: PostincR, dst: R }, word 0x0000_1E64 of 0x0000_1F7C, Load, Base;
            /// `a = R - 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwNegC = Lddw.D.neg_c { mem: NegC, dst: D }, word 0x0000_0164 of 0x0080_1F7C, Load, Base;
            /// `a = R + 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPosC = Lddw.D.pos_c { mem: PosC, dst: D }, word 0x0000_0364 of 0x0080_1F7C, Load, Base;
            /// `a = R - 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwNegR = Lddw.D.neg_r { mem: NegR, dst: D }, word 0x0000_0964 of 0x0080_1F7C, Load, Base;
            /// `a = R + 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPosR = Lddw.D.pos_r { mem: PosR, dst: D }, word 0x0000_0B64 of 0x0080_1F7C, Load, Base;
            /// `a = R = R - 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPredecC = Lddw.D.predec_c { mem: PredecC, dst: D }, word 0x0000_1164 of 0x0080_1F7C, Load, Base;
            /// `a = R = R + 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPreincC = Lddw.D.preinc_c { mem: PreincC, dst: D }, word 0x0000_1364 of 0x0080_1F7C, Load, Base;
            /// `a = R; R = R - 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPostdecC = Lddw.D.postdec_c { mem: PostdecC, dst: D }, word 0x0000_1564 of 0x0080_1F7C, Load, Base;
            /// `a = R; R = R + 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPostincC = Lddw.D.postinc_c { mem: PostincC, dst: D }, word 0x0000_1764 of 0x0080_1F7C, Load, Base;
            /// `a = R = R - 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPredecR = Lddw.D.predec_r { mem: PredecR, dst: D }, word 0x0000_1964 of 0x0080_1F7C, Load, Base;
            /// `a = R = R + 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPreincR = Lddw.D.preinc_r { mem: PreincR, dst: D }, word 0x0000_1B64 of 0x0080_1F7C, Load, Base;
            /// `a = R; R = R - 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPostdecR = Lddw.D.postdec_r { mem: PostdecR, dst: D }, word 0x0000_1D64 of 0x0080_1F7C, Load, Base;
            /// `a = R; R = R + 8*off; a &= ~7; dst lo = mem32[a], dst hi = mem32[a+4]`
            LddwPostincR = Lddw.D.postinc_r { mem: PostincR, dst: D }, word 0x0000_1F64 of 0x0080_1F7C, Load, Base;
            /// `R = y ? B15 : B14; a = R + 2*off; a &= ~1; dst = zx16(mem[a])`
            LdhuPosU15 = Ldhu.D.pos_u15 { mem: PosU15, dst: R }, word 0x0000_000C of 0x0000_007C, Load, Base;
            /// `R = y ? B15 : B14; a = R + off; dst = zx8(mem[a])`
            LdbuPosU15 = Ldbu.D.pos_u15 { mem: PosU15, dst: R }, word 0x0000_001C of 0x0000_007C, Load, Base;
            /// `R = y ? B15 : B14; a = R + off; dst = sx8(mem[a])`
            LdbPosU15 = Ldb.D.pos_u15 { mem: PosU15, dst: R }, word 0x0000_002C of 0x0000_007C, Load, Base;
            /// `R = y ? B15 : B14; a = R + 2*off; a &= ~1; dst = sx16(mem[a])`
            LdhPosU15 = Ldh.D.pos_u15 { mem: PosU15, dst: R }, word 0x0000_004C of 0x0000_007C, Load, Base;
            /// `R = y ? B15 : B14; a = R + 4*off; a &= ~3; dst = mem32[a]`
            LdwPosU15 = Ldw.D.pos_u15 { mem: PosU15, dst: R }, word 0x0000_006C of 0x0000_007C, Load, Base;
        }
    };
}
